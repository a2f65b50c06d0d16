//! Bounds that the author of a function states for a part of its range, so that searches can be proven.

use std::sync::Arc;

use crate::{Bounds, ContourError, Frame, Range};

/// Parts of the range on which limits are checked, and of which a box is made up.
const CELLS: usize = 96;

/// Samples of each of these parts.
const SAMPLES: usize = 8;

/// Accepted excess of a sample over a limit, relative: the rounding of both.
const ROUNDING: f64 = 1e-12;

/// Limits of the speed and of the curvature over a part of a [`Graph`](crate::Graph) or [`Curve`](crate::Curve).
///
/// Every value on the part lies within. They need not be sharp, but must become so with the part's length: the
/// searches halve parts until the limits decide. A limit that is not known is infinite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// The largest length travelled per unit of the parameter, `|dr/dt|`.
    pub speed: f64,
    /// The least and the largest signed curvature, one over a length: positive where the curve bends to the left. For a graph
    /// that is `g'' / (1 + g'^2)^(3/2)`.
    pub curvature: (f64, f64),
}

/// The limits over a part.
pub(crate) type LimitsOf = Arc<dyn Fn(Range) -> Limits + Send + Sync>;

/// Checks that samples of a shape lie within their limits: of the whole range, of halves and so on, and of 96 parts.
pub(crate) fn check(frame: impl Fn(f64) -> Frame, limits: &LimitsOf, range: Range) -> Result<(), ContourError> {
    let wholes = [1, 2, 4, 8, 16, 32, CELLS];
    for count in wholes {
        let samples = SAMPLES.max(CELLS / count);
        for cell in 0..count {
            let [from, to] = [cell, cell + 1].map(|end| range.at(end as f64 / count as f64));
            let part = Range { from, to };
            let Limits { speed, curvature: (least, largest) } = limits(part);
            for sample in 0..=samples {
                let t = part.at(sample as f64 / samples as f64);
                let frame = frame(t);
                let wrong = |what, value: f64, limit: f64| {
                    Err(ContourError::BeyondLimit { what, t, value, limit, from: part.from, to: part.to })
                };
                // Written so that NaN is wrong.
                if !(..=speed * (1.0 + ROUNDING)).contains(&frame.speed) {
                    return wrong("the speed", frame.speed, speed);
                }
                let curvature = frame.curvature();
                // Of a curvature that nearly vanishes by cancellation only the parts are exact to rounding.
                let accepted = ROUNDING * (curvature.abs() + 1.0 / (frame.speed * range.length()));
                if !(least - accepted..).contains(&curvature) {
                    return wrong("the curvature", curvature, least);
                }
                if !(..=largest + accepted).contains(&curvature) {
                    return wrong("the curvature", curvature, largest);
                }
            }
        }
    }
    Ok(())
}

/// A box that contains the part: an arc lies within the ellipse whose foci are its ends and whose axis is as long as it is.
pub(crate) fn bounds(frame: impl Fn(f64) -> Frame, limits: &LimitsOf, range: Range) -> Bounds {
    let mut bounds = Bounds::EMPTY;
    let mut left = frame(range.from);
    let mut from = range.from;
    for cell in 1..=CELLS {
        let to = range.at(cell as f64 / CELLS as f64);
        let right = frame(to);
        let length = limits(Range { from, to }).speed * (to - from);
        let chord = [right.x - left.x, right.y - left.y];
        let square = (length * length - chord[0] * chord[0] - chord[1] * chord[1]).max(0.0);
        let center = [0.5 * (left.x + right.x), 0.5 * (left.y + right.y)];
        for (side, along) in chord.into_iter().enumerate() {
            let reach = 0.5 * (square + along * along).sqrt();
            bounds.min[side] = bounds.min[side].min(center[side] - reach);
            bounds.max[side] = bounds.max[side].max(center[side] + reach);
        }
        (from, left) = (to, right);
    }
    if bounds.is_finite() { bounds } else { Bounds::ALL }
}

/// Bounds of a curvature of which nothing is known, one over a length.
pub(crate) const ANY_CURVATURE: (f64, f64) = (f64::NEG_INFINITY, f64::INFINITY);

/// Bounds of no curvature at all, to begin a union with.
pub(crate) const NO_CURVATURE: (f64, f64) = (f64::INFINITY, f64::NEG_INFINITY);

/// The bounds of the curvatures within either of two bounds.
pub(crate) fn curvature_union(one: (f64, f64), other: (f64, f64)) -> (f64, f64) {
    (one.0.min(other.0), one.1.max(other.1))
}

/// The bounds of some curvatures, each widened by `relative` of itself.
pub(crate) fn curvature_bounds(values: impl IntoIterator<Item = f64>, relative: f64) -> (f64, f64) {
    values.into_iter().fold(NO_CURVATURE, |bounds, value| {
        let margin = relative * value.abs();
        curvature_union(bounds, (value - margin, value + margin))
    })
}
