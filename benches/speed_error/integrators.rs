//! What integrates a segment instead of the closed form, at each of its settings.

use crate::rk4::FixedSteps;
use vibrissa::rod::{Method, Ode, Propagator};

/// An integrator at one setting.
pub struct Integrator {
    pub name: Name,
    /// Tolerance, or number of steps.
    pub setting: String,
    pub rod: Box<dyn Propagator>,
    /// About what it leaves of an error, as far as is known beforehand: its tolerance.
    pub tolerance: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Name {
    Dop853,
    Dopri5,
    Rk4,
}

impl Name {
    /// As a method for a segment.
    pub fn of_segments(self) -> &'static str {
        match self {
            Self::Dop853 => "Dop853",
            Self::Dopri5 => "Dopri5",
            Self::Rk4 => "RK4",
        }
    }

    /// As a method for a boundary-value problem.
    pub fn of_shooting(self) -> &'static str {
        match self {
            Self::Dop853 => "shooting, Dop853",
            Self::Dopri5 => "shooting, Dopri5",
            Self::Rk4 => "shooting, RK4",
        }
    }

    /// As a method for the inversion of reactions.
    pub fn of_inversion(self) -> &'static str {
        match self {
            Self::Dop853 => "through Dop853",
            Self::Dopri5 => "through Dopri5",
            Self::Rk4 => "through RK4",
        }
    }
}

/// Tolerances 1e-3 to 1e-14, every one or every second of them.
fn adaptive(every: usize) -> impl Iterator<Item = Integrator> {
    [(Name::Dop853, Method::Dop853), (Name::Dopri5, Method::Dopri5)].into_iter().flat_map(move |(name, method)| {
        (3..=14).step_by(every).map(move |digits| {
            let setting = format!("1e-{digits}");
            let tolerance = setting.parse().unwrap();
            Integrator { name, setting, rod: Box::new(Ode::uniform(method, tolerance).unwrap()), tolerance }
        })
    })
}

/// 4 to 1024 steps, each power of two or every second of them. What they leave of an error is not known beforehand.
fn fixed(every: usize) -> impl Iterator<Item = Integrator> {
    (2..=10).step_by(every).map(|power| {
        let steps = 1 << power;
        Integrator { name: Name::Rk4, setting: steps.to_string(), rod: Box::new(FixedSteps(steps)), tolerance: 0.0 }
    })
}

/// All integrators at every setting, or at every second one.
pub fn integrators(every: usize) -> Vec<Integrator> {
    adaptive(every).chain(fixed(every)).collect()
}
