//! The displacement of a clamp on springs under its reactions, and its derivative by a quantity.

use crate::derivatives::quantity::Quantity;
use rod_core::{ClampLaw, Reactions, Units};

/// A clamp on springs under its reactions, dimensionless.
#[derive(Clone, Debug)]
pub(crate) struct Given {
    compliance: [[f64; 3]; 3],
    reactions: [f64; 3],
}

impl Given {
    pub fn new(law: ClampLaw, Reactions { f0x, f0y, m0z }: Reactions) -> Self {
        Self { compliance: law.compliance, reactions: [f0x, f0y, m0z] }
    }

    /// The change of compliance times reactions (x, y, phi; dimensionless) under the same dimensionless reactions, per SI unit of the
    /// quantity.
    pub fn rates(&self, units: &Units, quantity: Quantity<'_>) -> [f64; 3] {
        let Units { length, force, moment, .. } = *units;
        let spring = match quantity {
            // in units of force and moment, which are proportional to E I
            Quantity::Stiffness => return self.times(|_, _| 1.0 / (moment * length)),
            // of E I / L^3 along x and y, E I / L^2 across, E I / L
            Quantity::Length => {
                let powers = |i: usize, j: usize| 1.0 + f64::from(u8::from(i < 2)) + f64::from(u8::from(j < 2));
                return self.times(|i, j| -powers(i, j) / length);
            }
            Quantity::ClampStiffnessX => 0,
            Quantity::ClampStiffnessY => 1,
            Quantity::ClampStiffnessPhi => 2,
            _ => return [0.0; 3],
        };
        // dC = -C dK C: what gives way along the spring, and the unit of its stiffness
        let unit = if spring < 2 { force / length } else { moment };
        let given = self.times(|_, _| 1.0)[spring] / unit;
        self.compliance.map(|row| -row[spring] * given)
    }

    /// Compliance, entry by entry times a factor, times reactions.
    fn times(&self, factor: impl Fn(usize, usize) -> f64) -> [f64; 3] {
        std::array::from_fn(|i| (0..3).map(|j| self.compliance[i][j] * factor(i, j) * self.reactions[j]).sum())
    }
}
