//! How a spline is stored: the keys of the crate `splines`, which no other file names.

use splines::{Interpolate, Interpolation, Key};

use crate::shapes::cubic::Cubic;
use crate::{ContourError, Point, Vector};

/// Points of a spline with their parameters and the two Bezier handles of each, 64 bytes a point.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Deserialize, serde::Serialize), serde(transparent))]
pub(super) struct Keys(splines::Spline<f64, KeyPoint>);

/// A point of the plane that the crate can interpolate.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Deserialize, serde::Serialize), serde(rename = "Point"))]
struct KeyPoint(Point);

impl Keys {
    /// The cubics that pass through the points at the knots with these velocities (`dr/dt`). All three are equally long;
    /// the knots rise.
    pub fn new(knots: &[f64], points: &[Point], velocities: &[Vector]) -> Self {
        let width = |k: usize| knots.get(k + 1).map(|next| next - knots[k]);
        let keys = points.iter().zip(velocities).enumerate().map(|(k, (&point, velocity))| {
            let before = k.checked_sub(1).and_then(width);
            let after = width(k);
            // The outer handles of the two ends are never used; they mirror the inner ones.
            let (before, after) = (before.or(after).unwrap_or(0.0), after.or(before).unwrap_or(0.0));
            let handle = |third: f64| KeyPoint([0, 1].map(|side| point[side] + third * velocity[side]));
            let handles = Interpolation::StrokeBezier(handle(-before / 3.0), handle(after / 3.0));
            Key::new(knots[k], KeyPoint(point), handles)
        });
        Self(splines::Spline::from_iter(keys))
    }

    /// Checks that this crate could have written these keys: at least two, finite, in order, with two handles each.
    pub fn check(&self) -> Result<(), ContourError> {
        let keys = self.0.keys();
        if keys.len() < 2 {
            return Err(ContourError::TooFewPoints { what: "a spline", count: keys.len(), needed: 2 });
        }
        let mut before = f64::NEG_INFINITY;
        for (index, key) in keys.iter().enumerate() {
            let number = index + 1;
            let Interpolation::StrokeBezier(KeyPoint(first), KeyPoint(second)) = key.interpolation else {
                return Err(ContourError::KeyKind { key: number });
            };
            let numbers = [key.t, key.value.0[0], key.value.0[1], first[0], first[1], second[0], second[1]];
            if let Some(&value) = numbers.iter().find(|value| !value.is_finite()) {
                return Err(ContourError::KeyNotFinite { key: number, value });
            }
            if key.t <= before {
                return Err(ContourError::KeyOrder { key: number, t: key.t, before });
            }
            before = key.t;
        }
        Ok(())
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Parameter of a point.
    pub fn knot(&self, index: usize) -> f64 {
        self.0.keys()[index].t
    }

    /// A point.
    pub fn point(&self, index: usize) -> Point {
        self.0.keys()[index].value.0
    }

    /// The cubic from one point to the next.
    pub fn cubic(&self, index: usize) -> Cubic {
        let [here, next] = [self.0.keys()[index], self.0.keys()[index + 1]];
        // Keys of another kind have not passed the check.
        let out = if let Interpolation::StrokeBezier(_, out) = here.interpolation { out } else { here.value };
        let into = if let Interpolation::StrokeBezier(into, _) = next.interpolation { into } else { next.value };
        Cubic { control: [here.value.0, out.0, into.0, next.value.0], from: here.t, width: next.t - here.t }
    }

    /// How many of the knots that follow the first one, and precede the last one, are at most `t`: the index of the cubic
    /// that holds `t`, the outer cubics beyond the ends.
    pub fn cubic_at(&self, t: f64) -> usize {
        let keys = self.0.keys();
        keys[1..keys.len() - 1].partition_point(|key| key.t <= t)
    }

    /// The point at `t` by the crate's own arithmetic; `None` beyond the ends.
    pub fn sample(&self, t: f64) -> Option<Point> {
        // The crate gives no value at the last key, and panics on NaN.
        let (first, last) = (self.knot(0), self.knot(self.len() - 1));
        if !(first <= t && t <= last) {
            return None;
        }
        self.0.clamped_sample(t).map(|point| point.0)
    }
}

/// Both coordinates by the crate's arithmetic for numbers.
impl Interpolate<f64> for KeyPoint {
    fn step(t: f64, threshold: f64, a: Self, b: Self) -> Self {
        Self([0, 1].map(|k| f64::step(t, threshold, a.0[k], b.0[k])))
    }

    fn lerp(t: f64, a: Self, b: Self) -> Self {
        Self([0, 1].map(|k| f64::lerp(t, a.0[k], b.0[k])))
    }

    fn cosine(t: f64, a: Self, b: Self) -> Self {
        Self([0, 1].map(|k| f64::cosine(t, a.0[k], b.0[k])))
    }

    fn cubic_hermite(t: f64, x: (f64, Self), a: (f64, Self), b: (f64, Self), y: (f64, Self)) -> Self {
        let side = |k: usize, at: (f64, Self)| (at.0, at.1.0[k]);
        Self([0, 1].map(|k| f64::cubic_hermite(t, side(k, x), side(k, a), side(k, b), side(k, y))))
    }

    fn quadratic_bezier(t: f64, a: Self, u: Self, b: Self) -> Self {
        Self([0, 1].map(|k| f64::quadratic_bezier(t, a.0[k], u.0[k], b.0[k])))
    }

    fn cubic_bezier(t: f64, a: Self, u: Self, v: Self, b: Self) -> Self {
        Self([0, 1].map(|k| f64::cubic_bezier(t, a.0[k], u.0[k], v.0[k], b.0[k])))
    }

    fn cubic_bezier_mirrored(t: f64, a: Self, u: Self, v: Self, b: Self) -> Self {
        Self([0, 1].map(|k| f64::cubic_bezier_mirrored(t, a.0[k], u.0[k], v.0[k], b.0[k])))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn keys(points: &[Point]) -> Keys {
        let knots: Vec<_> = (0..points.len()).map(|k| k as f64).collect();
        Keys::new(&knots, points, &vec![[1.0, 0.5]; points.len()])
    }

    #[test]
    fn a_point_takes_64_bytes() {
        assert_eq!(size_of::<Key<f64, Point>>(), 64);
    }

    #[test]
    fn keys_that_are_not_ours() {
        let message = |keys: Keys| keys.check().unwrap_err().to_string();
        assert!(keys(&[[0.0, 0.0], [1.0, 0.0]]).check().is_ok());
        assert_eq!(message(keys(&[[0.0, 0.0]])), "a spline needs at least 2 points, got 1");
        assert_eq!(
            message(keys(&[[0.0, 0.0], [f64::INFINITY, 0.0]])),
            "key 2 of the spline contains inf, expected finite numbers"
        );
        let mut other = keys(&[[0.0, 0.0], [1.0, 0.0]]);
        *other.0.get_mut(1).unwrap().interpolation = Interpolation::Linear;
        assert_eq!(
            message(other),
            "key 2 of the spline is of another kind, expected interpolation `stroke_bezier` with its two handles"
        );
    }

    #[test]
    fn the_samples_include_both_ends_and_nothing_else() {
        let keys = keys(&[[0.0, 0.0], [1.0, 0.0], [3.0, 1.0]]);
        assert_eq!(keys.sample(0.0), Some([0.0, 0.0]));
        assert_eq!(keys.sample(2.0), Some([3.0, 1.0]));
        for t in [-1e-9, 2.0 + 1e-9, f64::NAN, f64::INFINITY] {
            assert_eq!(keys.sample(t), None);
        }
        assert_eq!([-1.0, 0.0, 0.5, 1.0, 2.0, 3.0, f64::NAN].map(|t| keys.cubic_at(t)), [0, 0, 0, 1, 1, 1, 0]);
    }
}
