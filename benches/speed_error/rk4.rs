//! The classical Runge-Kutta method with a given number of equal steps. The only file that knows the crate `ode_solvers`.

use ode_solvers::{Rk4, System, Vector4};
use vibrissa::rod::{Cut, Propagator, RodError};

/// A uniform straight rod, integrated in so many steps a segment.
#[derive(Clone, Copy)]
pub struct FixedSteps(pub u32);

struct Equations {
    a: f64,
    b: f64,
}

impl System<f64, Vector4<f64>> for Equations {
    fn system(&self, _s: f64, state: &Vector4<f64>, rate: &mut Vector4<f64>) {
        let (sin, cos) = state[2].sin_cos();
        *rate = Vector4::new(cos, sin, state[3], self.a * cos + self.b * sin);
    }
}

impl Propagator for FixedSteps {
    fn advance(&self, _s: f64, start: &Cut, a: f64, b: f64, length: f64) -> Result<Cut, RodError> {
        if length == 0.0 {
            return Ok(*start);
        }
        let steps = f64::from(self.0);
        let step = length / steps;
        // it takes as many whole steps as are needed to pass the end: half a step less than the way gives the number wanted
        let end = step * (steps - 0.5);
        let state = Vector4::new(start.x, start.y, start.phi, start.moment);
        let mut solver = Rk4::new(Equations { a, b }, 0.0, state, end, step);
        let stopped = |error: String| RodError::Integration { s: 0.0, reason: error };
        solver.integrate().map_err(|error| stopped(error.to_string()))?;
        let end = solver.y_out().last().ok_or_else(|| stopped("no steps".to_owned()))?;
        Ok(Cut { x: end[0], y: end[1], phi: end[2], moment: end[3] })
    }
}
