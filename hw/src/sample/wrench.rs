//! Force and torque.

use core::array::from_fn;
use core::ops::{Add, Mul, Neg, Sub};
use nalgebra::{ClosedAddAssign, ClosedMulAssign, ClosedSubAssign, Vector3};
use num_traits::{One, Zero};
use rod_core::Scalar;

/// Force and torque about the origin of its axes.
///
/// ```
/// use rod_hw::Wrench;
/// let bias = Wrench { force: [0.1, 0.0, 0.0], torque: [0.0, 0.0, 2e-3] };
/// assert_eq!((bias + bias - bias) * 2.0, bias * 2.0);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wrench<T = f64> {
    /// Force, N.
    pub force: [T; 3],
    /// Torque, N m.
    pub torque: [T; 3],
}

impl<T: Number> Wrench<T> {
    /// From Fx, Fy, Fz (N), Tx, Ty, Tz (N m).
    pub fn from_components([fx, fy, fz, tx, ty, tz]: [T; 6]) -> Self {
        Self { force: [fx, fy, fz], torque: [tx, ty, tz] }
    }

    /// Fx, Fy, Fz (N), Tx, Ty, Tz (N m).
    pub fn components(&self) -> [T; 6] {
        let ([fx, fy, fz], [tx, ty, tz]) = (self.force, self.torque);
        [fx, fy, fz, tx, ty, tz]
    }

    /// The same about a point at d (m) from the origin, in the same axes: the torque becomes M - d x F.
    ///
    /// ```
    /// use rod_hw::Wrench;
    /// let wrench: Wrench = Wrench { force: [0.0, 0.5, 0.0], torque: [0.0, 0.0, 7e-3] };
    /// assert!((wrench.about([0.012, 0.0, 0.0]).torque[2] - 1e-3).abs() < 1e-15);
    /// ```
    pub fn about(&self, d: [T; 3]) -> Self {
        let [d, force, torque] = [d, self.force, self.torque].map(Vector3::from);
        Self { force: self.force, torque: (torque - d.cross(&force)).into() }
    }

    /// Whether all components are numbers.
    pub fn is_finite(&self) -> bool {
        self.components().iter().all(|c| c.to_f64().is_finite())
    }

    /// Component by component.
    pub fn map(&self, f: impl Fn(T) -> T) -> Self {
        Self::from_components(self.components().map(f))
    }

    /// Component by component, with those of another.
    pub fn zip(&self, other: &Self, f: impl Fn(T, T) -> T) -> Self {
        let (a, b) = (self.components(), other.components());
        Self::from_components(from_fn(|i| f(a[i], b[i])))
    }
}

impl<T: Number> Add for Wrench<T> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        self.zip(&other, |a, b| a + b)
    }
}

impl<T: Number> Sub for Wrench<T> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self.zip(&other, |a, b| a - b)
    }
}

impl<T: Number> Neg for Wrench<T> {
    type Output = Self;
    fn neg(self) -> Self {
        self.map(|a| -a)
    }
}

impl<T: Number> Mul<T> for Wrench<T> {
    type Output = Self;
    fn mul(self, factor: T) -> Self {
        self.map(|a| a * factor)
    }
}

/// A number of the kernel that vectors and matrices of nalgebra can have: `f32`, `f64`.
pub trait Number: Scalar + nalgebra::Scalar + Zero + One + ClosedAddAssign + ClosedSubAssign + ClosedMulAssign {}

impl<T: Scalar + nalgebra::Scalar + Zero + One + ClosedAddAssign + ClosedSubAssign + ClosedMulAssign> Number for T {}
