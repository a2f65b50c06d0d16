//! The clamp: where it stands and what it feels.

use crate::scalar::Scalar;

/// Position and direction of the clamp.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Pose<T = f64> {
    /// Position along x (m, or dimensionless inside the library).
    pub x: T,
    /// Position along y.
    pub y: T,
    /// Slope angle of the rod at the clamp, radians.
    pub phi: T,
}

/// What the clamp feels: the support reactions of the rod.
///
/// With A = sum f_j cos alpha_j and B = sum f_j sin alpha_j over all contacts: f0x = -B, f0y = A, m0z = -kappa(0) E I.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Reactions<T = f64> {
    /// Force along x, N.
    pub f0x: T,
    /// Force along y, N.
    pub f0y: T,
    /// Moment about z, N m.
    pub m0z: T,
}

impl<T: Scalar> Reactions<T> {
    /// The phase criterion K = m0z^2 - 2 E I (f0y sin phi0 + f0x cos phi0), N^2 m^2: zero exactly when the last contact is
    /// tangential (phases B, BB, ...), because each tangential contact adds f sin(phi - alpha) = 0 to the first integral of
    /// the elastica. Merker et al. (2020), eq. 20, is the case phi0 = pi / 2. `phi0` is the clamp angle (radians),
    /// `bending_stiffness` in N m^2.
    ///
    /// ```
    /// use rod_core::Reactions;
    /// let free = Reactions::default();
    /// assert_eq!(free.phase_criterion(0.3, 1.0), 0.0);
    /// ```
    pub fn phase_criterion(&self, phi0: T, bending_stiffness: T) -> T {
        let (sin, cos) = phi0.sin_cos();
        self.m0z * self.m0z - T::from_f64(2.0) * bending_stiffness * (self.f0y * sin + self.f0x * cos)
    }
}
