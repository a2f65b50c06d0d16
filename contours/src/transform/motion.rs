//! Rotation, translation, scaling and mirroring of the plane.

use crate::{ContourError, Point, Vector, check};

/// A similarity of the plane: `r' = translation + scale R(rotation) M r`, where M maps `y` to `-y` if `mirror` is set.
///
/// Mirroring comes first, then scale and rotation about the origin, then translation. A motion is plain data; what uses it
/// checks it.
///
/// ```
/// use std::f64::consts::FRAC_PI_2;
/// use rod_contours::Motion;
///
/// let motion = Motion { rotation: FRAC_PI_2, translation: [1.0, 0.0], ..Motion::IDENTITY };
/// let [x, y] = motion.apply([2.0, 0.0]);
/// assert!((x - 1.0).abs() < 1e-15 && (y - 2.0).abs() < 1e-15);
///
/// // Twice: the second motion is applied to what the first one gives.
/// let [x, y] = motion.then(motion).apply([2.0, 0.0]);
/// assert!((x + 1.0).abs() < 1e-15 && (y - 1.0).abs() < 1e-15);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// Angle of the rotation, rad, counterclockwise.
    pub rotation: f64,
    /// Translation, which is added last, lengths.
    pub translation: Vector,
    /// Factor of all lengths, positive.
    pub scale: f64,
    /// Whether y becomes -y, before anything else.
    pub mirror: bool,
}

impl Motion {
    /// The motion that leaves everything where it is.
    pub const IDENTITY: Self = Self { rotation: 0.0, translation: [0.0, 0.0], scale: 1.0, mirror: false };

    /// The rotation about the origin by `angle`, rad.
    pub fn rotation(angle: f64) -> Self {
        Self { rotation: angle, ..Self::IDENTITY }
    }

    /// The scaling of all lengths from the origin by `factor`, which must be positive.
    pub fn scale(factor: f64) -> Self {
        Self { scale: factor, ..Self::IDENTITY }
    }

    /// This motion first, then the other.
    pub fn then(self, other: Self) -> Self {
        let rotation = if other.mirror { -self.rotation } else { self.rotation };
        Self {
            rotation: other.rotation + rotation,
            translation: other.apply(self.translation),
            scale: other.scale * self.scale,
            mirror: other.mirror != self.mirror,
        }
    }

    /// Where the motion takes the point.
    pub fn apply(&self, point: Point) -> Point {
        let (sin, cos) = self.rotation.sin_cos();
        self.apply_with([cos, sin], point)
    }

    /// [`apply`](Self::apply) with cosine and sine of the rotation known.
    pub(crate) fn apply_with(&self, [cos, sin]: Vector, [x, y]: Point) -> Point {
        let y = if self.mirror { -y } else { y };
        [self.translation[0] + self.scale * (x * cos - y * sin), self.translation[1] + self.scale * (x * sin + y * cos)]
    }

    /// The point that the motion takes to `point`, with cosine and sine of the rotation known.
    pub(crate) fn undo_with(&self, [cos, sin]: Vector, [x, y]: Point) -> Point {
        let (dx, dy) = ((x - self.translation[0]) / self.scale, (y - self.translation[1]) / self.scale);
        let (x, y) = (dx * cos + dy * sin, dy * cos - dx * sin);
        [x, if self.mirror { -y } else { y }]
    }

    /// The motion, if all its numbers are finite and its scale is positive.
    pub(crate) fn check(self) -> Result<Self, ContourError> {
        check::finite([
            ("the motion's rotation", self.rotation),
            ("x of the motion's translation", self.translation[0]),
            ("y of the motion's translation", self.translation[1]),
            ("the motion's scale", self.scale),
        ])?;
        check::positive("the motion's scale", self.scale)?;
        Ok(self)
    }
}

impl Default for Motion {
    fn default() -> Self {
        Self::IDENTITY
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn motions_compose() {
        let one = Motion { rotation: 0.3, translation: [1.0, -2.0], scale: 2.0, mirror: false };
        let other = Motion { rotation: -1.1, translation: [0.1, 0.7], scale: 0.3, mirror: true };
        for (first, second) in [(one, one), (one, other), (other, one), (other, other)] {
            let point = [0.4, 0.9];
            let (twice, once) = (second.apply(first.apply(point)), first.then(second).apply(point));
            assert!((twice[0] - once[0]).hypot(twice[1] - once[1]) < 1e-15);
            let (sin, cos) = first.rotation.sin_cos();
            let back = first.undo_with([cos, sin], first.apply(point));
            assert!((back[0] - point[0]).hypot(back[1] - point[1]) < 1e-15);
        }
        assert_eq!(one.then(Motion::IDENTITY), one);
        assert_eq!(Motion::default().then(other), other);
    }

    #[test]
    fn a_mirror_keeps_its_line() {
        let [x, y] = Motion { rotation: 0.8, mirror: true, ..Motion::default() }.apply([0.4_f64.cos(), 0.4_f64.sin()]);
        assert!((x - 0.4_f64.cos()).abs() < 1e-15 && (y - 0.4_f64.sin()).abs() < 1e-15);
        assert_eq!(Motion::scale(2.0).apply([1.0, 3.0]), [2.0, 6.0]);
        assert_eq!(Motion::rotation(0.0).apply([1.0, 3.0]), [1.0, 3.0]);
    }
}
