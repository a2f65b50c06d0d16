//! The clamp: where it stands, what it feels, and both at one instant of a scan.

use crate::segment::Scalar;

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

/// Where the clamp was and what it felt, SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Sample<T = f64> {
    /// Time, s, where it is known.
    pub t: Option<T>,
    /// The clamp.
    pub pose: Pose<T>,
    /// What it felt.
    pub reactions: Reactions<T>,
    /// Standard deviations of the reactions, where the sensor tells them.
    pub sigma: Option<Reactions<T>>,
}

impl<T> Sample<T> {
    /// A sample without time and standard deviations.
    ///
    /// ```
    /// use rod_core::{Pose, Reactions, Sample};
    /// let free = Sample::new(Pose { x: 0.0, y: 0.0, phi: 1.5 }, Reactions::default());
    /// assert!(free.t.is_none() && free.sigma.is_none());
    /// ```
    pub fn new(pose: Pose<T>, reactions: Reactions<T>) -> Self {
        Self { t: None, pose, reactions, sigma: None }
    }
}
