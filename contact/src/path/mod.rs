//! The way the clamp goes: straight, along an arc, about a pivot, along a spline or anything else, one leg after another.

mod arc;
mod chain;
mod spline;
mod straight;

pub use arc::ClampArc;
pub use chain::Chain;
pub use spline::ClampSpline;
pub use straight::ClampPath;
pub(crate) use straight::check;

use rod_core::Pose;
use std::sync::Arc;

/// A point of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathPoint {
    /// The clamp: m, m, radians.
    pub pose: Pose,
    /// Its change by the path's parameter.
    pub rate: Pose,
}

/// A path of the clamp, for [`Sweep`](crate::Sweep). One method is required; closures are paths too.
///
/// 1. `point(t)` is finite for t from 0 to [`length`](Self::length), its angle at most
///    [`LARGEST_ANGLE`](crate::LARGEST_ANGLE). Beyond, the sweep goes straight on by itself.
/// 2. `rate` is the derivative of `pose` by t, and continuous: a path with corners is a [`Chain`]. A sweep compares the two at some
///    parameters ([`ContactError::Rate`](crate::ContactError::Rate)).
///
/// The parameter may be anything. A path may slow down, stand still and turn back; then the sweep reports poses as they come.
///
/// ```
/// use rod_contact::{PathPoint, Sweep};
/// use rod_contours::{Composite, Parabola};
/// use rod_core::{Pose, Rod};
/// use std::f64::consts::{FRAC_PI_2, TAU};
/// let (rod, object) = (Rod::new(1.0, 1.0)?, Composite::single(Parabola::new([0.0, 0.0], 5.0)?)?);
/// // to and fro along x within one period, t = 0 to 1
/// let swing = |t: f64| PathPoint {
///     pose: Pose { x: 0.3 + 0.2 * (TAU * t).cos(), y: -0.4, phi: FRAC_PI_2 },
///     rate: Pose { x: -0.2 * TAU * (TAU * t).sin(), y: 0.0, phi: 0.0 },
/// };
/// let outcome = Sweep::new(&rod, &object, swing, 0.25)?.run();
/// let x: Vec<_> = outcome.states.iter().map(|state| (1e6 * state.pose.x).round() / 1e6).collect();
/// assert_eq!(x, [0.5, 0.3, 0.1, 0.3, 0.5]);
/// let phases: Vec<_> = outcome.events.iter().map(|event| event.to().to_string()).collect();
/// assert_eq!(phases.first().zip(phases.last()).map(|(a, b)| (a.as_str(), b.as_str())), Some(("A", "free")));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub trait Path: Send + Sync {
    /// Pose and rate at a parameter.
    fn point(&self, t: f64) -> PathPoint;

    /// The parameter at the end, 1 unless a path says otherwise; at the start it is 0.
    fn length(&self) -> f64 {
        1.0
    }

    /// The legs of which it consists, in order, each with a parameter of its own; none where it is a single one.
    fn legs(&self) -> &[Arc<dyn Path>] {
        &[]
    }

    /// The straight path that this one is, if it is one: it takes less arithmetic.
    fn straight(&self) -> Option<ClampPath> {
        None
    }
}

impl<F: Fn(f64) -> PathPoint + Send + Sync> Path for F {
    fn point(&self, t: f64) -> PathPoint {
        self(t)
    }
}
