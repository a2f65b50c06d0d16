//! The point, the direction and their rates at one parameter; how they change with a parameter of the shape.

use crate::Vector;

/// Point, tangent angle and their rates at a parameter `t` of a contour:
/// `dr/dt = speed (cos alpha, sin alpha)`, `d alpha/dt = turning`.
///
/// ```
/// use rod_contours::Frame;
///
/// // The bottom of a circle of radius 2, solid inside, by arc length.
/// let frame = Frame { x: 0.0, y: -2.0, alpha: 0.0, speed: 1.0, turning: 0.5 };
/// assert_eq!(frame.normal(), (-0.0, 1.0));
/// assert_eq!(frame.curvature(), 0.5);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// First coordinate of the point, a length.
    pub x: f64,
    /// Second coordinate of the point, a length.
    pub y: f64,
    /// Tangent angle, rad, continuous along the contour (it does not jump by whole turns).
    pub alpha: f64,
    /// Length travelled per unit of the parameter, never negative; 0 in a corner.
    pub speed: f64,
    /// Angle turned per unit of the parameter, rad; positive where the solid is convex.
    pub turning: f64,
}

impl Frame {
    /// The unit normal into the solid, `(-sin alpha, cos alpha)`.
    pub fn normal(&self) -> (f64, f64) {
        let (sin, cos) = self.alpha.sin_cos();
        (-sin, cos)
    }

    /// Curvature `d alpha/ds = turning / speed`, one over a length; positive where the solid is convex, infinite in a
    /// corner or notch (speed 0).
    pub fn curvature(&self) -> f64 {
        self.turning / self.speed
    }

    /// How far the point `(x, y)` lies ahead of this one along the tangent, and how far outside along the outward
    /// normal, both lengths.
    pub(crate) fn local(&self, x: f64, y: f64) -> (f64, f64) {
        let (sin, cos) = self.alpha.sin_cos();
        let (dx, dy) = (x - self.x, y - self.y);
        (dx * cos + dy * sin, dx * sin - dy * cos)
    }

    /// The distance to the point `(x, y)`, a length.
    pub(crate) fn distance(&self, x: f64, y: f64) -> f64 {
        (x - self.x).hypot(y - self.y)
    }
}

/// The change of the point and of the tangent angle of a [`Frame`](crate::Frame) per unit of a parameter of the shape, at a fixed
/// `t`.
///
/// ```
/// use rod_contours::{Contour, FrameRate, Parabola};
///
/// // y = c x^2: at t = x the height grows by x^2, and the angle, atan(2 c x), by 2 x / (1 + (2 c x)^2)
/// let rate = Parabola::new([0.0, 0.0], 5.0)?.frame_rate(0.1, "coefficient");
/// assert_eq!(rate, Some(FrameRate { x: 0.0, y: 0.1 * 0.1, alpha: 0.2 / 2.0 }));
/// # Ok::<(), rod_contours::ContourError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrameRate {
    /// Change of the first coordinate of the point, a length per unit of the parameter.
    pub x: f64,
    /// Change of the second coordinate of the point, a length per unit of the parameter.
    pub y: f64,
    /// Change of the tangent angle, rad per unit of the parameter.
    pub alpha: f64,
}

impl FrameRate {
    /// Nothing changes.
    pub const ZERO: Self = Self { x: 0.0, y: 0.0, alpha: 0.0 };

    /// The translation along x.
    pub(crate) const ALONG_X: Self = Self { x: 1.0, ..Self::ZERO };

    /// The translation along y.
    pub(crate) const ALONG_Y: Self = Self { y: 1.0, ..Self::ZERO };

    /// The rotation, per rad, of what is at this distance from the pivot, lengths.
    pub(crate) fn rotation([dx, dy]: Vector) -> Self {
        Self { x: -dy, y: dx, alpha: 1.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_to_the_right_is_outside() {
        let frame = Frame { x: 1.0, y: 1.0, alpha: std::f64::consts::FRAC_PI_2, speed: 1.0, turning: 0.0 };
        let (ahead, outside) = frame.local(1.5, 3.0);
        assert!((ahead - 2.0).abs() < 1e-15 && (outside - 0.5).abs() < 1e-15);
    }
}
