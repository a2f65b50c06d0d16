//! The curvature of a rod at rest, as a user gives it.

use crate::error::{RodError, finite};
use std::sync::Arc;

/// Relative rounding of an arc length at the tip.
const ROUNDING: f64 = 1e-9;

/// A function of the arc length.
pub(super) type Function = Arc<dyn Fn(f64) -> f64 + Send + Sync>;

/// The curvature of a rod at rest, 1/m, positive where the rod turns counter-clockwise from the clamp to the tip: a number or a
/// function of the arc length (m), which both turn into it, or [points](Self::points).
#[derive(Clone)]
pub struct NaturalCurvature(pub(super) Curvature);

#[derive(Clone)]
pub(super) enum Curvature {
    Constant(f64),
    Function(Function),
    /// Straight lines between points (arc length, curvature).
    Points(Arc<[[f64; 2]]>),
}

impl Curvature {
    /// As a function, and the arc lengths between which it is smooth.
    pub fn function(self) -> (Function, Vec<f64>) {
        match self {
            Self::Constant(curvature) => (Arc::new(move |_| curvature), Vec::new()),
            Self::Function(function) => (function, Vec::new()),
            Self::Points(points) => {
                let borders = points.iter().map(|[s, _]| *s).collect();
                (Arc::new(move |s| between(&points, s)), borders)
            }
        }
    }

    /// Whether its points, if it has some, are on a rod of this length.
    pub fn check(&self, length: f64) -> Result<(), RodError> {
        let Self::Points(points) = self else { return Ok(()) };
        let on_rod = |s: f64| (-ROUNDING * length..=length * (1.0 + ROUNDING)).contains(&s);
        match points.iter().position(|[s, _]| !on_rod(*s)) {
            Some(k) => {
                let expected = "a place on the rod, from 0 to its length";
                Err(RodError::CurvaturePoint { number: k + 1, s: points[k][0], expected })
            }
            None => Ok(()),
        }
    }

    /// In units of a length.
    pub fn over(self, length: f64) -> Self {
        match self {
            Self::Constant(curvature) => Self::Constant(curvature * length),
            Self::Function(function) => Self::Function(Arc::new(move |s| function(s * length) * length)),
            Self::Points(points) => {
                Self::Points(points.iter().map(|[s, curvature]| [s / length, curvature * length]).collect())
            }
        }
    }
}

/// On the line between the points before and after an arc length; beyond the first and the last one as there.
fn between(points: &[[f64; 2]], s: f64) -> f64 {
    let after = points.partition_point(|[at, _]| *at <= s);
    match (after.checked_sub(1).map(|before| points[before]), points.get(after)) {
        (Some([from, first]), Some([to, last])) => first + (last - first) * (s - from) / (to - from),
        (Some([_, curvature]), None) => curvature,
        (None, Some([_, curvature])) => *curvature,
        (None, None) => 0.0,
    }
}

impl NaturalCurvature {
    /// Straight lines between measured points: arc length (m, from the clamp) and curvature (1/m). Before the first and beyond the last
    /// point the curvature is as there.
    ///
    /// ```
    /// use rod_core::{NaturalCurvature, Rod};
    /// let measured = NaturalCurvature::points(&[[0.0, 5.0], [0.02, 20.0], [0.04, 25.0]])?;
    /// let whisker = Rod::tapered(0.04, 1e-4, 2e-5, 3e9)?.with_natural_curvature(measured)?;
    /// let message = NaturalCurvature::points(&[[0.02, 5.0], [0.0, 20.0]]).map(drop).unwrap_err().to_string();
    /// assert_eq!(message, "point 2 of the natural curvature has the arc length 0 m, expected more than that of the point before");
    /// # Ok::<(), rod_core::RodError>(())
    /// ```
    ///
    /// # Errors
    /// [`RodError::NotPositive`] without points, [`RodError::NotFinite`], [`RodError::CurvaturePoint`] for arc lengths that do not grow.
    pub fn points(points: &[[f64; 2]]) -> Result<Self, RodError> {
        if points.is_empty() {
            return Err(RodError::NotPositive { what: "the number of points of the natural curvature", value: 0.0 });
        }
        for [s, curvature] in points {
            finite("arc length of a point of the natural curvature", *s)?;
            finite("natural_curvature", *curvature)?;
        }
        if let Some(k) = (1..points.len()).find(|&k| points[k][0] <= points[k - 1][0]) {
            let expected = "more than that of the point before";
            return Err(RodError::CurvaturePoint { number: k + 1, s: points[k][0], expected });
        }
        Ok(Self(Curvature::Points(points.into())))
    }
}

impl From<f64> for NaturalCurvature {
    fn from(curvature: f64) -> Self {
        Self(Curvature::Constant(curvature))
    }
}

impl<F: Fn(f64) -> f64 + Send + Sync + 'static> From<F> for NaturalCurvature {
    fn from(function: F) -> Self {
        Self(Curvature::Function(Arc::new(function)))
    }
}
