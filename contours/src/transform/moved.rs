//! A shape somewhere else, turned, scaled or mirrored.

use std::f64::consts::PI;

use crate::contour::{Seal, Trust};
use crate::nearest::cuts;
use crate::{Bounds, Closest, Contour, ContourError, Frame, FrameRate, Motion, Range, Vector};

/// A shape after a [`Motion`].
///
/// The parameter is that of the shape, except that a mirrored shape is travelled backwards (by `-t`), so that the solid
/// stays on its left. Closest points and bounds are those of the shape, seen through the inverse motion, as exact as
/// they are there; the bounds are the box around the shape's own box, wider than the moved shape unless the rotation is by
/// quarters, and the whole plane where the shape's box is infinite.
///
/// Parameters of [`frame_rate`](Contour::frame_rate): `rotation`, `translation_x`, `translation_y` and `scale` of the motion, and
/// those of the shape with other names.
///
/// ```
/// use std::f64::consts::FRAC_PI_2;
/// use rod_contours::{Contour, Motion, Moved, Parabola};
///
/// // A parabola that opens to the left; the solid is on the left.
/// let shape = Moved::new(Parabola::new([0.0, 0.0], 5.0)?, Motion::rotation(FRAC_PI_2))?;
/// assert!((shape.gap(0.2, 0.0) - 0.2).abs() < 1e-15);
///
/// let mirrored = Moved::new(shape, Motion { rotation: 2.0 * FRAC_PI_2, mirror: true, ..Motion::IDENTITY })?;
/// assert!((mirrored.gap(-0.2, 0.0) - 0.2).abs() < 1e-15);
/// # Ok::<(), rod_contours::ContourError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moved<C> {
    shape: C,
    motion: Motion,
    /// Cosine and sine of the rotation.
    axis: Vector,
}

impl<C: Contour> Moved<C> {
    /// The shape after the motion.
    ///
    /// # Errors
    ///
    /// [`ContourError::NotFinite`] for a number of the motion that is not finite, [`ContourError::NotPositive`] for a scale
    /// that is not positive.
    pub fn new(shape: C, motion: Motion) -> Result<Self, ContourError> {
        let motion = motion.check()?;
        let (sin, cos) = motion.rotation.sin_cos();
        Ok(Self { shape, motion, axis: [cos, sin] })
    }

    /// A range of the shape as one of the moved shape, and the other way round.
    fn mirror_range(&self, range: Range) -> Range {
        if self.motion.mirror { range.backwards() } else { range }
    }

    /// A parameter of the shape as one of the moved shape, and the other way round.
    fn parameter(&self, t: f64) -> f64 {
        if self.motion.mirror { -t } else { t }
    }

    fn moved_frame(&self, frame: Frame) -> Frame {
        let [x, y] = self.motion.apply_with(self.axis, [frame.x, frame.y]);
        let alpha = if self.motion.mirror { PI - frame.alpha } else { frame.alpha };
        Frame { x, y, alpha: self.motion.rotation + alpha, speed: self.motion.scale * frame.speed, ..frame }
    }

    fn moved_closest(&self, closest: Closest) -> Closest {
        Closest {
            t: self.parameter(closest.t),
            gap: self.motion.scale * closest.gap,
            frame: self.moved_frame(closest.frame),
            ..closest
        }
    }

    fn moved_bounds(&self, bounds: Bounds) -> Bounds {
        if !bounds.is_finite() {
            return Bounds::ALL;
        }
        let Bounds { min, max } = bounds;
        [[min[0], min[1]], [min[0], max[1]], [max[0], min[1]], [max[0], max[1]]]
            .into_iter()
            .map(|corner| self.motion.apply_with(self.axis, corner))
            .fold(Bounds::EMPTY, |bounds, [x, y]| bounds.with(x, y))
    }
}

impl<C: Contour> Contour for Moved<C> {
    fn frame(&self, t: f64) -> Frame {
        self.moved_frame(self.shape.frame(self.parameter(t)))
    }

    fn range(&self) -> Range {
        self.mirror_range(self.shape.range())
    }

    fn closest(&self, x: f64, y: f64) -> Closest {
        let [x, y] = self.motion.undo_with(self.axis, [x, y]);
        self.moved_closest(self.shape.closest(x, y))
    }

    fn closest_in(&self, range: Range, x: f64, y: f64) -> Closest {
        let [x, y] = self.motion.undo_with(self.axis, [x, y]);
        self.moved_closest(self.shape.closest_in(self.mirror_range(range), x, y))
    }

    fn gap(&self, x: f64, y: f64) -> f64 {
        let [x, y] = self.motion.undo_with(self.axis, [x, y]);
        self.motion.scale * self.shape.gap(x, y)
    }

    fn bounds(&self) -> Bounds {
        self.moved_bounds(self.shape.bounds())
    }

    fn bounds_in(&self, range: Range) -> Bounds {
        self.moved_bounds(self.shape.bounds_in(self.mirror_range(range)))
    }

    fn cuts(&self, range: Range) -> Vec<f64> {
        let cuts = self.shape.cuts(self.mirror_range(range));
        if self.motion.mirror { cuts::reverse(cuts) } else { cuts }
    }

    fn is_convex(&self, range: Range) -> bool {
        self.shape.is_convex(self.mirror_range(range))
    }

    fn curvature_in(&self, range: Range) -> (f64, f64) {
        let (least, largest) = self.shape.curvature_in(self.mirror_range(range));
        (least / self.motion.scale, largest / self.motion.scale)
    }

    fn closest_is_exact(&self) -> bool {
        self.shape.closest_is_exact()
    }

    fn frame_rate(&self, t: f64, parameter: &str) -> Option<FrameRate> {
        let Motion { translation, scale, mirror, .. } = self.motion;
        let from_pivot = || {
            let Frame { x, y, .. } = self.frame(t);
            [x - translation[0], y - translation[1]]
        };
        match parameter {
            "translation_x" => Some(FrameRate::ALONG_X),
            "translation_y" => Some(FrameRate::ALONG_Y),
            "rotation" => Some(FrameRate::rotation(from_pivot())),
            "scale" => {
                let [dx, dy] = from_pivot();
                Some(FrameRate { x: dx / scale, y: dy / scale, alpha: 0.0 })
            }
            of_the_shape => {
                let FrameRate { x, y, alpha } = self.shape.frame_rate(self.parameter(t), of_the_shape)?;
                let turned = Motion { translation: [0.0, 0.0], ..self.motion };
                let [x, y] = turned.apply_with(self.axis, [x, y]);
                Some(FrameRate { x, y, alpha: if mirror { -alpha } else { alpha } })
            }
        }
    }

    fn trust(&self, seal: Seal) -> Trust {
        self.shape.trust(seal)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{CircularArc, EllipticArc, Line, Parabola};

    #[test]
    fn a_moved_arc_is_the_arc_elsewhere() {
        let motion = Motion { rotation: 0.5, translation: [1.0, 2.0], scale: 3.0, mirror: true };
        let arc = CircularArc::new([0.2, 0.1], 0.5, 0.1, 1.9).unwrap();
        let moved = Moved::new(arc, motion).unwrap();
        let same = CircularArc::new(motion.apply([0.2, 0.1]), 1.5, 0.5 - 1.9, 0.5 - 0.1).unwrap();
        assert!((moved.range().length() * 3.0 - same.range().length()).abs() < 1e-14);
        for k in 0..50 {
            let (x, y) = (f64::from(k) * 0.1 - 1.0, (f64::from(k) * 0.7).sin() + 2.0);
            let (one, two) = (moved.closest(x, y), same.closest(x, y));
            assert!((one.gap - two.gap).abs() < 1e-14 && one.interior == two.interior);
            assert!((one.frame.alpha - two.frame.alpha).abs() < 1e-14, "{one:?} {two:?}");
            assert!(((one.t - moved.range().from) * 3.0 - two.t).abs() < 1e-14);
        }
    }

    #[test]
    fn cuts_and_bounds_are_moved_too() {
        let ellipse = EllipticArc::new([0.0, 0.0], [2.0, 1.0], 0.0, 0.5, 5.0).unwrap();
        let moved = Moved::new(ellipse, Motion { rotation: 0.6, mirror: true, ..Motion::IDENTITY }).unwrap();
        let expected: Vec<f64> = ellipse.cuts(ellipse.range()).iter().rev().map(|cut| -cut).collect();
        assert_eq!(moved.cuts(moved.range()), expected);
        let line = Moved::new(Line::new([0.0, 0.0], [1.0, 1.0]).unwrap(), Motion::scale(2.0)).unwrap();
        assert_eq!(line.bounds(), Bounds { min: [0.0, 0.0], max: [2.0, 2.0] });
        let open = Moved::new(Parabola::new([0.0, 0.0], 1.0).unwrap(), Motion::rotation(1.0)).unwrap();
        assert_eq!(open.bounds(), Bounds::ALL);
    }

    #[test]
    fn motions_that_cannot_be() {
        let line = Line::new([0.0, 0.0], [1.0, 1.0]).unwrap();
        let message = |motion| Moved::new(line, motion).unwrap_err().to_string();
        assert_eq!(message(Motion::scale(-2.0)), "the motion's scale is -2, expected a positive number");
        assert_eq!(message(Motion::rotation(f64::NAN)), "the motion's rotation is NaN, expected a finite number");
    }
}
