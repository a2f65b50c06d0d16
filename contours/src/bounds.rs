//! A box around a contour.

use crate::{Point, Vector};

/// A box with sides along the axes that contains a contour; its sides may be infinitely far.
///
/// ```
/// use rod_contours::Bounds;
///
/// let bounds = Bounds::EMPTY.with(0.0, 1.0).with(2.0, 0.0);
/// assert_eq!(bounds, Bounds { min: [0.0, 0.0], max: [2.0, 1.0] });
/// assert!(bounds.contains(1.0, 0.5));
/// assert_eq!(bounds.distance(5.0, 5.0), 5.0);
/// assert!(bounds.is_finite() && bounds.meets(&bounds.grown(1.0)));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Smallest x and y, lengths.
    pub min: Point,
    /// Largest x and y, lengths.
    pub max: Point,
}

impl Bounds {
    /// The box that contains nothing.
    pub const EMPTY: Self = Self { min: [f64::INFINITY; 2], max: [f64::NEG_INFINITY; 2] };

    /// The whole plane.
    pub const ALL: Self = Self { min: [f64::NEG_INFINITY; 2], max: [f64::INFINITY; 2] };

    /// The smallest box that also contains the point `(x, y)`.
    pub fn with(&self, x: f64, y: f64) -> Self {
        self.union(Self { min: [x, y], max: [x, y] })
    }

    /// The smallest box that contains both.
    pub fn union(&self, other: Self) -> Self {
        Self {
            min: [self.min[0].min(other.min[0]), self.min[1].min(other.min[1])],
            max: [self.max[0].max(other.max[0]), self.max[1].max(other.max[1])],
        }
    }

    /// The box with every side moved out by `margin`, a length.
    pub fn grown(&self, margin: f64) -> Self {
        Self { min: self.min.map(|side| side - margin), max: self.max.map(|side| side + margin) }
    }

    /// Whether the point `(x, y)` lies in the box, sides included.
    pub fn contains(&self, x: f64, y: f64) -> bool {
        (self.min[0]..=self.max[0]).contains(&x) && (self.min[1]..=self.max[1]).contains(&y)
    }

    /// Whether both boxes share a point.
    pub fn meets(&self, other: &Self) -> bool {
        (0..2).all(|i| self.min[i] <= other.max[i] && other.min[i] <= self.max[i])
    }

    /// Whether all sides are at finite places.
    pub fn is_finite(&self) -> bool {
        self.min.iter().chain(&self.max).all(|side| side.is_finite())
    }

    /// Distance of the point `(x, y)` from the box, a length; 0 inside.
    pub fn distance(&self, x: f64, y: f64) -> f64 {
        let [dx, dy] = self.vector_from(x, y);
        // One of the two is 0 for most points: no root then.
        if dx == 0.0 || dy == 0.0 { dx + dy } else { (dx * dx + dy * dy).sqrt() }
    }

    /// The square of [`distance`](Self::distance).
    pub(crate) fn square_distance(&self, x: f64, y: f64) -> f64 {
        let [dx, dy] = self.vector_from(x, y);
        dx * dx + dy * dy
    }

    /// How far the point is beyond the sides, along x and along y.
    fn vector_from(&self, x: f64, y: f64) -> Vector {
        [(self.min[0] - x).max(x - self.max[0]).max(0.0), (self.min[1] - y).max(y - self.max[1]).max(0.0)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_infinitely_far_and_everything_is_here() {
        assert_eq!(Bounds::EMPTY.distance(0.0, 0.0), f64::INFINITY);
        assert_eq!(Bounds::ALL.distance(1e300, -1e300), 0.0);
        assert!(!Bounds::EMPTY.contains(0.0, 0.0));
    }

    #[test]
    fn distance_from_a_half_plane() {
        let above = Bounds { min: [f64::NEG_INFINITY, 1.0], max: [f64::INFINITY; 2] };
        assert_eq!(above.distance(100.0, -1.0), 2.0);
        assert_eq!(above.grown(0.5).distance(100.0, -1.0), 1.5);
    }
}
