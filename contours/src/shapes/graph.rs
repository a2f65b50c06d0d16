//! The graph of a function.

use std::fmt;
use std::sync::Arc;

use super::function::{self, Function, Jet, variable};
use crate::contour::{Seal, Trust};
use crate::nearest::search::CELLS;
use crate::proof::limits::LimitsOf;
use crate::{Bounds, Closest, Contour, ContourError, Frame, Limits, Range, Vector, check};

/// g, g' and g'' at x.
type Derivatives = dyn Fn(f64) -> [f64; 3] + Send + Sync;

/// The graph `y = g(x)`, travelled to +x: the solid is above.
///
/// The parameter is x. The frame is as exact as the function; closest points come from the search of the trait, of
/// which see the limits at [`Contour::closest_in`]. Iterations may ask for g a little beyond the range.
///
/// ```
/// use rod_contours::{Contour, DualNum, Graph, Range};
///
/// let chain = Graph::new(Range { from: -2.0, to: 2.0 }, |x| x.cosh())?;
/// let frame = chain.frame(0.0);
/// assert_eq!((frame.y, frame.alpha, frame.turning), (1.0, 0.0, 1.0));
/// assert!((chain.gap(0.0, 0.25) - 0.75).abs() < 1e-15);
///
/// let steep = Graph::with_derivatives(Range::ALL, |x| [x * x * x, 3.0 * x * x, 6.0 * x])?;
/// assert_eq!(steep.frame(1.0).alpha, 3.0_f64.atan());
/// # Ok::<(), rod_contours::ContourError>(())
/// ```
#[derive(Clone)]
pub struct Graph {
    range: Range,
    derivatives: Arc<Derivatives>,
    limits: Option<LimitsOf>,
}

impl Graph {
    /// The graph of `g` over a range of x, lengths, whose ends may be infinite. The derivatives are computed along with g,
    /// exactly.
    ///
    /// # Errors
    ///
    /// [`ContourError::EmptyRange`] unless the range's start is less than its end (NaN included);
    /// [`ContourError::NotFiniteAt`] if g or one of its first two derivatives is not finite at one of 97 samples of the
    /// range, which reach 1e4 far where it is infinite.
    pub fn new(range: Range, g: impl Fn(Jet) -> Jet + Send + Sync + 'static) -> Result<Self, ContourError> {
        Self::with_derivatives(range, move |x| {
            let jet = g(variable(x));
            [jet.re, jet.v1, jet.v2]
        })
    }

    /// The graph of a function that gives its value and its first two derivatives `[g, g', g'']`.
    ///
    /// # Errors
    ///
    /// As for [`new`](Self::new).
    pub fn with_derivatives(
        range: Range,
        derivatives: impl Fn(f64) -> [f64; 3] + Send + Sync + 'static,
    ) -> Result<Self, ContourError> {
        check::range("x of the graph", range)?;
        for cell in 0..=CELLS {
            let t = range.at(cell as f64 / CELLS as f64);
            let [value, first, second] = derivatives(t);
            check::finite_at(t, [("g", value), ("g'", first), ("g''", second)])?;
        }
        Ok(Self { range, derivatives: Arc::new(derivatives), limits: None })
    }

    /// The same with limits of its speed and curvature over any part of its range, by which its closest points, box,
    /// inflections and convex parts are proven in place of sampled ([`Contour::closest_is_exact`]). A closest point takes a few tens
    /// of parts with sharp limits; what limits leave undecided after 2e5 parts stays at the nearest point found.
    ///
    /// ```
    /// use rod_contours::{Contour, DualNum, Graph, Limits, Range};
    ///
    /// // y = sin x / 8: the slope is at most 1/8, and the curvature between its values for slopes of 0 and 1/8.
    /// let waves = Graph::new(Range { from: 0.0, to: 20.0 }, |x| x.sin() * 0.125)?.with_limits(|part| {
    ///     // The largest -sin x of the part, and the least: at the middle, plus or minus half the length.
    ///     let (middle, half) = (-part.at(0.5).sin(), 0.5 * part.length());
    ///     let bend = [(middle - half).max(-1.0) * 0.125, (middle + half).min(1.0) * 0.125];
    ///     let [steep, flat] = [1.0_f64 + 0.125 * 0.125, 1.0].map(|stretch| stretch.powf(-1.5));
    ///     let least = bend[0] * if bend[0] < 0.0 { flat } else { steep };
    ///     let largest = bend[1] * if bend[1] < 0.0 { steep } else { flat };
    ///     Limits { speed: (1.0_f64 + 0.125 * 0.125).sqrt(), curvature: (least, largest) }
    /// })?;
    /// assert!(waves.closest_is_exact() && waves.is_convex(Range { from: 0.0, to: 3.1 }));
    /// # Ok::<(), rod_contours::ContourError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`ContourError::NotFinite`] for a range that is infinite; [`ContourError::BeyondLimit`] where one of 768 samples lies
    /// outside the limits of a part around it. Values between the samples are not tested.
    pub fn with_limits(self, limits: impl Fn(Range) -> Limits + Send + Sync + 'static) -> Result<Self, ContourError> {
        let known = function::check_limits(&self, limits)?;
        Ok(Self { limits: Some(known), ..self })
    }
}

impl Function for Graph {
    fn limits(&self) -> Option<&LimitsOf> {
        self.limits.as_ref()
    }

    fn derivatives_at(&self, t: f64) -> [Vector; 3] {
        let [value, first, second] = (self.derivatives)(t);
        [[t, value], [1.0, first], [0.0, second]]
    }
}

impl fmt::Debug for Graph {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.debug_struct("Graph").field("range", &self.range).finish_non_exhaustive()
    }
}

impl Contour for Graph {
    fn frame(&self, t: f64) -> Frame {
        let [y, slope, bend] = (self.derivatives)(t);
        let speed = slope.hypot(1.0);
        Frame { x: t, y, alpha: slope.atan(), speed, turning: bend / speed / speed }
    }

    fn range(&self) -> Range {
        self.range
    }

    function::methods_of_function!();

    fn trust(&self, _: Seal) -> Trust {
        Trust { contract: false, simple: true }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{DualNum, Parabola};

    #[test]
    fn a_graph_of_a_square_is_a_parabola() {
        let graph = Graph::new(Range::ALL, |x| (x - 0.25).powi(2) * 5.0 + 0.5).unwrap();
        let parabola = Parabola::new([0.25, 0.5], 5.0).unwrap();
        for k in 0..100 {
            let t = f64::from(k) * 0.0625 - 3.0;
            let (one, two) = (graph.frame(t + 0.25), parabola.frame(t));
            assert!((one.turning - two.turning).abs() <= 1e-15 * two.turning);
            assert_eq!(Frame { turning: 0.0, speed: 0.0, ..one }, Frame { turning: 0.0, speed: 0.0, ..two });
            assert!((one.speed - two.speed).abs() <= 1e-15 * two.speed);
            let (x, y) = (t, (3.0 * t).sin());
            assert!((graph.gap(x, y) - parabola.gap(x, y)).abs() < 1e-13);
        }
        assert_eq!(format!("{graph:?}"), "Graph { range: Range { from: -inf, to: inf }, .. }");
    }

    #[test]
    fn graphs_that_cannot_be() {
        let log = Graph::new(Range { from: 0.0, to: 1.0 }, |x| x.ln()).unwrap_err();
        assert_eq!(
            log.to_string(),
            "g is -inf at t = 0, expected finite numbers on the whole range (up to 1e4 along an infinite one); trim the range"
        );
        assert!(Graph::new(Range::ALL, |x| x.cosh()).unwrap_err().to_string().starts_with("g is inf at t = -"));
        let empty = Graph::new(Range { from: 1.0, to: f64::NAN }, |x| x).unwrap_err();
        assert_eq!(empty.to_string(), "x of the graph runs from 1 to NaN, expected the start to be less than the end");
    }
}
