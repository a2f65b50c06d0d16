//! The one place that converts between SI and the dimensionless quantities inside.

use crate::segment::Scalar;

/// What one dimensionless unit is in SI: multiply to come out, divide to go in. Lengths are in L, forces in E I / L^2,
/// moments in E I / L (Merker et al. 2020, eq. 1).
///
/// ```
/// let units = rod_core::Rod::new(0.1, 2e-3)?.units();
/// assert!((units.force - 0.2).abs() < 1e-15); // N
/// assert!((units.moment - 0.02).abs() < 1e-15); // N m
/// # Ok::<(), rod_core::RodError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Units<T = f64> {
    /// m
    pub length: T,
    /// N
    pub force: T,
    /// N m
    pub moment: T,
    /// 1/m
    pub curvature: T,
    /// J
    pub energy: T,
}

impl<T: Scalar> Units<T> {
    /// Units of a rod of `length` (m) and `bending_stiffness` (N m^2).
    pub(crate) fn new(length: T, bending_stiffness: T) -> Self {
        let moment = bending_stiffness / length;
        Self { length, force: moment / length, moment, curvature: T::from_f64(1.0) / length, energy: moment }
    }
}

impl Units {
    /// The units of a rod that is dimensionless already.
    pub const ONE: Self = Self { length: 1.0, force: 1.0, moment: 1.0, curvature: 1.0, energy: 1.0 };
}
