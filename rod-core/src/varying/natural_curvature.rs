//! The curvature of a rod at rest, as a user gives it.

use crate::error::{RodError, finite};
use std::sync::Arc;

/// Relative rounding of the arc lengths of both ends.
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

    /// Whether its points, if it has some, go from the clamp to the tip of a rod of this length: what is beyond them nobody measured, and points in
    /// parts of the length or in mm end elsewhere.
    pub fn check(&self, length: f64) -> Result<(), RodError> {
        let Self::Points(points) = self else { return Ok(()) };
        let is_off = |s: f64, expected: f64| (s - expected).abs() > ROUNDING * length;
        let ends = [(1, points.first(), 0.0), (points.len(), points.last(), length)];
        let off = ends.into_iter().find_map(|(number, point, expected)| {
            let s = point.filter(|point| is_off(point[0], expected))?[0];
            Some(RodError::CurvatureEnd { number, s, expected, length })
        });
        off.map_or(Ok(()), Err)
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

/// On the line between the points before and after an arc length; beyond the first and the last one, by rounding, as there.
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
    /// Straight lines between measured points: arc length (m, from the clamp) and curvature (1/m), from 0 to the length of the rod.
    ///
    /// ```
    /// use rod_core::{NaturalCurvature, Rod};
    /// let measured = NaturalCurvature::points(&[[0.0, 5.0], [0.02, 20.0], [0.04, 25.0]])?;
    /// let whisker = Rod::tapered(0.04, 1e-4, 2e-5, 3e9)?.with_natural_curvature(measured)?;
    /// let message = NaturalCurvature::points(&[[0.02, 5.0], [0.0, 20.0]]).map(drop).unwrap_err().to_string();
    /// assert_eq!(message, "point 2 of natural_curvature has the arc length 0 m, expected more than that of the point before");
    /// # Ok::<(), rod_core::RodError>(())
    /// ```
    ///
    /// # Errors
    /// [`RodError::NotPositive`] without points, [`RodError::NotFinite`], [`RodError::CurvaturePoint`] for arc lengths that do not grow.
    pub fn points(points: &[[f64; 2]]) -> Result<Self, RodError> {
        if points.is_empty() {
            return Err(RodError::NotPositive { what: "the number of points of natural_curvature", value: 0.0 });
        }
        for [s, curvature] in points {
            finite("arc length of a point of natural_curvature", *s)?;
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
