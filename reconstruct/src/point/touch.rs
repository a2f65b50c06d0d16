//! A contact point found from reactions.

use crate::numeric::Number;
use nalgebra::Matrix2;
use rod_core::Units;

/// A contact point of the rod and the object, SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(bound(serialize = "T: Number + serde::Serialize", deserialize = "T: Number + serde::Deserialize<'de>"))
)]
pub struct Touch<T = f64> {
    /// Arc length along the rod, m.
    pub s: T,
    /// Position, m.
    pub x: T,
    /// Position, m.
    pub y: T,
    /// Tangent angle of the contour, radians, in (-pi, pi], with the solid on its left. Without friction the contact force on the rod is
    /// force (sin alpha, -cos alpha); friction turns it.
    pub alpha: T,
    /// Size of the contact force, with its friction, N, >= 0.
    pub force: T,
    /// Covariance of the position (x, y), m^2; zero where the noise is not known.
    pub covariance: Matrix2<T>,
    /// The part of it that errors cause which all samples of a scan share: bias, gain, angle of the clamp and so on. It does not average
    /// out. Zero where no such errors are taken into account.
    pub systematic: Matrix2<T>,
}

impl<T: Number> Touch<T> {
    /// In SI units, from dimensionless.
    pub(crate) fn in_units(self, units: Units<T>) -> Self {
        let Units { length, force, .. } = units;
        Self {
            s: self.s * length,
            x: self.x * length,
            y: self.y * length,
            alpha: self.alpha,
            force: self.force * force,
            covariance: self.covariance * (length * length),
            systematic: self.systematic * (length * length),
        }
    }

    /// Standard deviation of the position across the contour, m. Only this error displaces the contour; one along it does not.
    pub fn sigma_normal(&self) -> T {
        self.across(&self.covariance)
    }

    /// The part of [`sigma_normal`](Self::sigma_normal) that all samples of a scan share, m.
    pub fn sigma_systematic(&self) -> T {
        self.across(&self.systematic)
    }

    /// The same point with errors of this covariance besides, which all samples of a scan share.
    #[cfg(feature = "std")]
    pub(crate) fn with_systematic(self, systematic: Matrix2<T>) -> Self {
        Self { covariance: self.covariance + systematic, systematic, ..self }
    }

    fn across(&self, c: &Matrix2<T>) -> T {
        let (sin, cos) = self.alpha.sin_cos();
        (sin * sin * c[(0, 0)] - T::from_f64(2.0) * sin * cos * c[(0, 1)] + cos * cos * c[(1, 1)]).max(T::zero()).sqrt()
    }
}
