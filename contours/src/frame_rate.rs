//! How a frame changes with a parameter of its shape.

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
    pub(crate) fn rotation([dx, dy]: [f64; 2]) -> Self {
        Self { x: -dy, y: dx, alpha: 1.0 }
    }
}
