//! Intervals put together of parts, each of which knows its own derivatives.

use crate::model::{Cut, CutSensitivities};

/// How a cut along an interval changes with angle, moment and force at the start of the interval.
pub(crate) struct Chain {
    /// As (x, y, phi, moment): by the moment at the start, and by the force components A and B.
    by: [[f64; 4]; 3],
}

impl Chain {
    pub fn new() -> Self {
        Self { by: [[0.0, 0.0, 0.0, 1.0], [0.0; 4], [0.0; 4]] }
    }

    /// The changes of angle and moment at the end of the last part, by the moment at the start, A and B.
    pub fn directions(&self) -> [[f64; 2]; 3] {
        self.by.map(|[_, _, phi, moment]| [phi, moment])
    }

    /// One part more, by what it adds to the position, and angle and moment at its end.
    pub fn extend(&mut self, ends: [[f64; 4]; 3]) {
        for (by, [x, y, phi, moment]) in self.by.iter_mut().zip(ends) {
            *by = [by[0] + x, by[1] + y, phi, moment];
        }
    }

    /// One part more, by its own sensitivities.
    pub fn then(&mut self, part: &CutSensitivities) {
        let by_force = [[0.0; 4], part.by_a, part.by_b];
        let directions = self.directions();
        self.extend(std::array::from_fn(|i| {
            let [phi, moment] = directions[i];
            std::array::from_fn(|k| phi * part.by_phi[k] + moment * part.by_moment[k] + by_force[i][k])
        }));
    }

    /// The sensitivities of the whole interval from `start`, where the curvature is `kappa_start`, to `end` with `kappa_end`.
    ///
    /// Turning the rod and the force together turns everything: that gives the derivative by the angle. Moving the start along the
    /// rod, the cut there kept, is moving the cut back by the differential equation.
    pub fn finish(self, start: (&Cut, f64), end: (&Cut, f64), a: f64, b: f64) -> CutSensitivities {
        let [by_moment, by_a, by_b] = self.by;
        let ((start, kappa_start), (end, kappa_end)) = (start, end);
        let (dx, dy) = (end.x - start.x, end.y - start.y);
        let turned = [-dy, dx, 1.0, 0.0];
        let by_phi: [f64; 4] = std::array::from_fn(|k| turned[k] + b * by_a[k] - a * by_b[k]);
        let (sin, cos) = start.phi.sin_cos();
        let moment_rate = a * cos + b * sin;
        let moved = [cos, sin, 0.0, 0.0];
        let by_from = std::array::from_fn(|k| -(moved[k] + kappa_start * by_phi[k] + moment_rate * by_moment[k]));
        let (sin, cos) = end.phi.sin_cos();
        CutSensitivities { by_phi, by_moment, by_a, by_b, by_from, by_to: [cos, sin, kappa_end, a * cos + b * sin] }
    }
}
