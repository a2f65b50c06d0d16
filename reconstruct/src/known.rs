//! The rod as its clamp knows it: from pose and reactions up to the first contact, dimensionless.

use nalgebra::{Matrix3, Matrix4x3, SMatrix, SVector, Vector3, Vector4};
use rod_core::{Pose, Reactions, Section, Units, advance, advance_with_sensitivities};

/// Clamp pose and reactions, dimensionless: x0, y0, phi0 and f0x, f0y, m0z; or their rates along the scan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Clamp {
    pub pose: Vector3<f64>,
    pub reactions: Vector3<f64>,
}

impl Clamp {
    pub fn new(units: Units, pose: Pose, reactions: Reactions) -> Self {
        Self {
            pose: Vector3::new(pose.x / units.length, pose.y / units.length, pose.phi),
            reactions: Vector3::new(
                reactions.f0x / units.force,
                reactions.f0y / units.force,
                reactions.m0z / units.moment,
            ),
        }
    }

    pub fn is_finite(&self) -> bool {
        self.pose.iter().chain(&self.reactions).all(|v| v.is_finite())
    }

    /// The cross-section at the clamp: kappa(0) = -m0z.
    pub fn section(&self) -> Section {
        Section { x: self.pose.x, y: self.pose.y, phi: self.pose.z, kappa: -self.reactions.z }
    }

    /// The force (A, B) = (f0y, -f0x) that the rod carries next to the clamp.
    pub fn force(&self) -> [f64; 2] {
        [self.reactions.y, -self.reactions.x]
    }

    pub fn at(&self, s: f64) -> Section {
        let [a, b] = self.force();
        advance(&self.section(), a, b, s)
    }

    /// The section at arc length s, with its derivatives.
    pub fn gradient_at(&self, s: f64) -> (Section, Gradient) {
        let [a, b] = self.force();
        let (end, by) = advance_with_sensitivities(&self.section(), a, b, s);
        let column = |c: [f64; 4]| Vector4::from(c);
        let by_reactions = Matrix4x3::from_columns(&[-column(by.by_b), column(by.by_a), -column(by.by_kappa)]);
        (end, Gradient { by_reactions, by_phi0: column(by.by_phi), by_s: column(by.by_s) })
    }

    /// The phase criterion K and its derivatives by the reactions (and phi0).
    pub fn criterion(&self) -> (f64, Vector3<f64>) {
        let (sin, cos) = self.pose.z.sin_cos();
        let r = &self.reactions;
        (r.z * r.z - 2.0 * (r.y * sin + r.x * cos), Vector3::new(-2.0 * cos, -2.0 * sin, 2.0 * r.z))
    }
}

/// Derivatives of a section (x, y, phi, kappa) of the rod; by x0 and y0 it only moves along.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Gradient {
    pub by_reactions: Matrix4x3<f64>,
    pub by_phi0: Vector4<f64>,
    pub by_s: Vector4<f64>,
}

impl Gradient {
    /// Rate of the section at a fixed arc length where the clamp and its reactions change at this rate.
    pub fn rate(&self, rate: &Clamp) -> Vector4<f64> {
        let carried = Vector4::new(rate.pose.x, rate.pose.y, 0.0, 0.0);
        carried + self.by_phi0 * rate.pose.z + self.by_reactions * rate.reactions
    }
}

/// J C J^T.
pub(crate) fn spread<const N: usize>(jacobian: &SMatrix<f64, N, 3>, covariance: &Matrix3<f64>) -> SMatrix<f64, N, N> {
    jacobian * covariance * jacobian.transpose()
}

/// Variance of a number with this gradient.
pub(crate) fn variance<const N: usize>(gradient: &SVector<f64, N>, covariance: &SMatrix<f64, N, N>) -> f64 {
    gradient.dot(&(covariance * gradient)).max(0.0)
}
