//! The rod: length, bending stiffness and, where it is known, the wire behind it.

use crate::error::RodError;
use crate::segment::Scalar;
use crate::units::Units;
use core::f64::consts::PI;

/// A straight, uniform, inextensible rod (Euler-Bernoulli). SI units, checked on construction.
///
/// ```
/// use rod_core::Rod;
/// // the spring steel wire of Merker et al. (2020): 100 mm long, 0.5 mm thick
/// let rod = Rod::from_diameter(0.1, 0.5e-3, 206e9)?;
/// assert!((rod.bending_stiffness() - 6.32e-4).abs() < 1e-6); // N m^2
/// assert!(Rod::new(-0.1, 1e-3).is_err());
/// # Ok::<(), rod_core::RodError>(())
/// ```
///
/// A rod is made in `f64`; [`cast`](Self::cast) gives the one that computes in `f32`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rod<T = f64> {
    length: T,
    bending_stiffness: T,
    wire: Option<Wire<T>>,
    yield_stress: Option<T>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Wire<T> {
    diameter: T,
    youngs_modulus: T,
}

impl Rod {
    /// A rod of `length` (m) and `bending_stiffness` E I (N m^2).
    ///
    /// # Errors
    /// [`RodError::NotPositive`] where one of them, or a [unit](Self::units) made of them, is not a positive, finite number.
    pub fn new(length: f64, bending_stiffness: f64) -> Result<Self, RodError> {
        positive("length", length)?;
        positive("bending_stiffness", bending_stiffness)?;
        let rod = Self { length, bending_stiffness, wire: None, yield_stress: None };
        positive("1 / length", rod.units().curvature)?;
        positive("bending_stiffness / length^2, the unit of force,", rod.units().force)?;
        positive("bending_stiffness / length, the unit of moment,", rod.units().moment)?;
        Ok(rod)
    }

    /// A round wire of `length` (m), `diameter` (m) and `youngs_modulus` (Pa): E I = E pi d^4 / 64.
    ///
    /// # Errors
    /// [`RodError::NotPositive`] where one of them is not a positive, finite number, and [`RodError::TooThick`] where the
    /// diameter is larger than the length.
    pub fn from_diameter(length: f64, diameter: f64, youngs_modulus: f64) -> Result<Self, RodError> {
        positive("diameter", diameter)?;
        positive("youngs_modulus", youngs_modulus)?;
        positive("length", length)?;
        if diameter > length {
            return Err(RodError::TooThick { diameter, length });
        }
        let square = diameter * diameter;
        let bending_stiffness = youngs_modulus * PI * (square * square) / 64.0;
        positive("youngs_modulus pi diameter^4 / 64, the bending stiffness,", bending_stiffness)?;
        let rod = Self::new(length, bending_stiffness)?;
        Ok(Self { wire: Some(Wire { diameter, youngs_modulus }), ..rod })
    }

    /// The same rod with a yield stress (Pa), to compare the bending stress with.
    ///
    /// # Errors
    /// [`RodError::NotPositive`] where it is not a positive, finite number.
    pub fn with_yield_stress(self, yield_stress: f64) -> Result<Self, RodError> {
        positive("yield_stress", yield_stress)?;
        Ok(Self { yield_stress: Some(yield_stress), ..self })
    }

    /// The same rod in numbers of another type, each rounded to the nearest. What is too small or too large for them becomes 0
    /// or infinite: of such a rod nothing that is computed is finite.
    ///
    /// ```
    /// use rod_core::Rod;
    /// let rod: Rod<f32> = Rod::new(0.1, 2e-3)?.cast();
    /// assert_eq!((rod.length(), rod.units().moment), (0.1_f32, 2e-3_f32 / 0.1));
    /// # Ok::<(), rod_core::RodError>(())
    /// ```
    pub fn cast<T: Scalar>(&self) -> Rod<T> {
        let to = T::from_f64;
        Rod {
            length: to(self.length),
            bending_stiffness: to(self.bending_stiffness),
            wire: self.wire.map(|w| Wire { diameter: to(w.diameter), youngs_modulus: to(w.youngs_modulus) }),
            yield_stress: self.yield_stress.map(to),
        }
    }
}

impl<T: Scalar> Rod<T> {
    /// Length, m.
    pub fn length(&self) -> T {
        self.length
    }

    /// Bending stiffness E I, N m^2.
    pub fn bending_stiffness(&self) -> T {
        self.bending_stiffness
    }

    /// Diameter, m, where it was given.
    pub fn diameter(&self) -> Option<T> {
        self.wire.map(|wire| wire.diameter)
    }

    /// Yield stress, Pa, where it was given.
    pub fn yield_stress(&self) -> Option<T> {
        self.yield_stress
    }

    /// Bending stress E d |kappa| / 2 (Pa) at the surface where the curvature is `kappa` (1/m); none for a rod given by its
    /// bending stiffness alone, whose thickness is not known.
    pub fn bending_stress(&self, kappa: T) -> Option<T> {
        let size = if kappa < T::from_f64(0.0) { -kappa } else { kappa };
        self.wire.map(|w| T::from_f64(0.5) * w.youngs_modulus * w.diameter * size)
    }

    /// What the dimensionless units of this rod are in SI.
    pub fn units(&self) -> Units<T> {
        Units::new(self.length, self.bending_stiffness)
    }
}

pub(crate) fn positive(what: &'static str, value: f64) -> Result<(), RodError> {
    if value.is_finite() && value > 0.0 { Ok(()) } else { Err(RodError::NotPositive { what, value }) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refuses_what_is_no_rod_and_says_what() {
        for (result, what) in [
            (Rod::new(0.0, 1.0), "length"),
            (Rod::new(1.0, f64::NAN), "bending_stiffness"),
            (Rod::new(1e-300, 1.0), "force"),
            (Rod::new(1e300, 1.0), "force"),
            (Rod::new(1e-310, 1e-310), "1 / length"),
            (Rod::from_diameter(1.0, -1.0, 1.0), "diameter"),
            (Rod::from_diameter(1.0, 1.0, f64::INFINITY), "youngs_modulus"),
            (Rod::from_diameter(1.0, 1e-100, 1.0), "youngs_modulus pi diameter^4 / 64"),
            (Rod::new(1.0, 1.0).unwrap().with_yield_stress(0.0), "yield_stress"),
        ] {
            let message = result.unwrap_err().to_string();
            assert!(message.contains(what) && message.contains("positive"), "{message}");
        }
    }

    #[test]
    fn a_wire_is_not_thicker_than_long() {
        // 0.5 mm, taken for 0.5 m
        let error = Rod::from_diameter(0.1, 0.5, 206e9).unwrap_err();
        assert_eq!(error, RodError::TooThick { diameter: 0.5, length: 0.1 });
        assert_eq!(error.to_string(), "diameter is 0.5 m, expected at most the length, 0.1 m");
        assert!(Rod::from_diameter(0.1, 0.1, 206e9).is_ok());
    }

    #[test]
    fn stress_needs_a_diameter() {
        let rod = Rod::from_diameter(0.1, 0.5e-3, 206e9).unwrap();
        assert_eq!(rod.bending_stress(-10.0), Some(0.5 * 206e9 * 0.5e-3 * 10.0));
        assert_eq!(Rod::new(0.1, 1e-3).unwrap().bending_stress(1.0), None);
    }
}
