//! A clamp on springs, from SI units.

use super::{Elastic, stored};
use crate::error::RodError;
use crate::pose::{Pose, Reactions};
use crate::units::Units;

/// Entries of a stiffness matrix that differ by less than this part of the geometric mean of their diagonals are symmetric, and
/// what elimination leaves of a diagonal below this part of it is nothing.
const ROUNDING: f64 = 1e-12;

/// A clamp that gives way: springs between the support and the base of the rod, in SI units.
///
/// ```
/// use rod_core::{ElasticClamp, Pose, Reactions, Rod};
/// let rod = Rod::new(0.1, 2e-3)?; // E I / L = 0.02 N m
/// let clamp = ElasticClamp::springs(Some(500.0), None, Some(0.4))?; // N/m, rigid, N m/rad
/// assert_eq!(clamp.energy(&Reactions { f0x: 2.0, f0y: 7.0, m0z: 0.0 }), 0.5 * 2.0 * 2.0 / 500.0); // J
/// // for `MultiPoint`, in units of the rod: 0.4 N m/rad are 20 E I / L
/// let held = clamp.at(Pose { x: 0.0, y: -0.4, phi: 1.5 }, &rod.units());
/// assert!((held.compliance[2][2] - 1.0 / 20.0).abs() < 1e-15);
/// let wrong = ElasticClamp::springs(None, Some(-3.0), None).unwrap_err();
/// assert_eq!(wrong.to_string(), "stiffness_y of the clamp is -3.0, expected a positive number, or infinity for a rigid direction");
/// # Ok::<(), rod_core::RodError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ElasticClamp {
    compliance: [[f64; 3]; 3],
}

impl ElasticClamp {
    /// Three springs along the axes of the world: N/m, N/m, N m/rad. None or infinity is rigid.
    ///
    /// # Errors
    /// [`RodError::ClampStiffness`] for what is not positive, or too small to have an inverse.
    pub fn springs(
        stiffness_x: Option<f64>,
        stiffness_y: Option<f64>,
        stiffness_phi: Option<f64>,
    ) -> Result<Self, RodError> {
        let mut compliance = [[0.0; 3]; 3];
        let springs = [("stiffness_x", stiffness_x), ("stiffness_y", stiffness_y), ("stiffness_phi", stiffness_phi)];
        for (i, (what, stiffness)) in springs.into_iter().enumerate() {
            let value = stiffness.unwrap_or(f64::INFINITY);
            compliance[i][i] = 1.0 / value;
            if value.is_nan() || value <= 0.0 || compliance[i][i].is_infinite() {
                let expected = "a positive number, or infinity for a rigid direction";
                return Err(RodError::ClampStiffness { what, value, expected });
            }
        }
        Ok(Self { compliance })
    }

    /// Springs that are coupled: the matrix K of (f0x, f0y, m0z) = -K (displacement of the base), in N/m, N/rad = N m/m, N m/rad.
    ///
    /// # Errors
    /// [`RodError::ClampStiffness`] where it is not finite, symmetric and positive definite.
    pub fn stiffness(matrix: [[f64; 3]; 3]) -> Result<Self, RodError> {
        const NAMES: [[&str; 3]; 3] = [
            ["stiffness[0][0]", "stiffness[0][1]", "stiffness[0][2]"],
            ["stiffness[1][0]", "stiffness[1][1]", "stiffness[1][2]"],
            ["stiffness[2][0]", "stiffness[2][1]", "stiffness[2][2]"],
        ];
        let wrong = |i: usize, j: usize, expected| {
            Err(RodError::ClampStiffness { what: NAMES[i][j], value: matrix[i][j], expected })
        };
        if let Some(i) = (0..3).find(|&i| !(matrix[i][i] > 0.0 && matrix[i][i].is_finite())) {
            return wrong(i, i, "a positive, finite number");
        }
        // a spring of 1 in each direction, so that units do not matter
        let size = [0, 1, 2].map(|i| matrix[i][i].sqrt());
        let mut scaled = [[0.0; 3]; 3];
        for i in 0..3 {
            for j in 0..3 {
                if !matrix[i][j].is_finite() {
                    return wrong(i, j, "a finite number");
                }
                if (matrix[i][j] - matrix[j][i]).abs() > ROUNDING * size[i] * size[j] {
                    return wrong(i, j, "the same as across the diagonal: a stiffness is symmetric");
                }
                scaled[i][j] = 0.5 * (matrix[i][j] + matrix[j][i]) / size[i] / size[j];
            }
        }
        let inverse = match inverted(scaled) {
            Ok(inverse) => inverse,
            Err(i) => return wrong(i, i, "more, for a positive definite matrix"),
        };
        let mut compliance = [[0.0; 3]; 3];
        for i in 0..3 {
            for j in 0..3 {
                compliance[i][j] = inverse[i][j] / size[i] / size[j];
                if !compliance[i][j].is_finite() {
                    return wrong(i, i, "large enough for an inverse");
                }
            }
        }
        Ok(Self { compliance })
    }

    /// Whether it gives way nowhere.
    pub fn is_rigid(&self) -> bool {
        self.compliance == [[0.0; 3]; 3]
    }

    /// Displacement (m, m, rad) per reaction (N, N, N m), row by row: symmetric.
    pub fn compliance(&self) -> [[f64; 3]; 3] {
        self.compliance
    }

    /// The energy that the springs store under these reactions (N, N m), in J.
    pub fn energy(&self, reactions: &Reactions) -> f64 {
        stored(&self.compliance, reactions)
    }

    /// The clamp of a rod with these units whose support is at `pose`, both dimensionless from here on.
    pub fn at(&self, pose: Pose, units: &Units) -> Elastic {
        let displacement = [units.length, units.length, 1.0];
        let reaction = [units.force, units.force, units.moment];
        let mut compliance = self.compliance;
        for (row, displacement) in compliance.iter_mut().zip(displacement) {
            row.iter_mut().zip(reaction).for_each(|(entry, reaction)| *entry *= reaction / displacement);
        }
        Elastic { pose, compliance }
    }
}

/// The inverse of a symmetric matrix by elimination without exchanges; the number of the first pivot that is not positive.
fn inverted(mut matrix: [[f64; 3]; 3]) -> Result<[[f64; 3]; 3], usize> {
    let mut inverse = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    for k in 0..3 {
        let pivot = matrix[k][k];
        if pivot <= ROUNDING {
            return Err(k);
        }
        let (from, other) = (matrix[k].map(|v| v / pivot), inverse[k].map(|v| v / pivot));
        for i in 0..3 {
            let factor = if i == k { 0.0 } else { matrix[i][k] };
            for j in 0..3 {
                matrix[i][j] = if i == k { from[j] } else { matrix[i][j] - factor * from[j] };
                inverse[i][j] = if i == k { other[j] } else { inverse[i][j] - factor * other[j] };
            }
        }
    }
    // elimination rounds the two halves differently
    let mean = |i: usize, j: usize| 0.5 * (inverse[i][j] + inverse[j][i]);
    Ok([0, 1, 2].map(|i| [0, 1, 2].map(|j| mean(i, j))))
}
