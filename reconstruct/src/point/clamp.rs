//! The rod between its clamp and its first contact, which pose and reactions determine; dimensionless.

use super::friction::normal_part;
use crate::numeric::Number;
use nalgebra::{Matrix4x3, Vector3, Vector4};
#[cfg(feature = "std")]
use rod_core::Sample;
use rod_core::{Pose, Reactions, Section, Units, advance, advance_with_sensitivities};

/// Clamp pose and reactions, dimensionless: x0, y0, phi0 and f0x, f0y, m0z; or their rates along the scan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Clamp<T = f64> {
    pub pose: Vector3<T>,
    pub reactions: Vector3<T>,
    /// Natural curvature of the rod, the same along it: 0 for a straight rod, and for rates.
    pub natural: T,
    /// Tangent of the angle by which friction turns the force of a contact, positive where it draws the rod from the clamp towards its
    /// tip: mu where the rod is drawn back over its contacts, -mu where it is pushed on; 0 without friction, and for rates.
    pub friction: T,
}

impl<T: Number> Clamp<T> {
    pub fn new(units: Units<T>, pose: Pose<T>, reactions: Reactions<T>) -> Self {
        Self {
            pose: Vector3::new(pose.x / units.length, pose.y / units.length, pose.phi),
            reactions: Vector3::new(
                reactions.f0x / units.force,
                reactions.f0y / units.force,
                reactions.m0z / units.moment,
            ),
            natural: T::zero(),
            friction: T::zero(),
        }
    }

    pub fn is_finite(&self) -> bool {
        self.pose.iter().chain(&self.reactions).all(|v| v.is_finite())
    }

    /// The cross-section at the clamp: kappa(0) is the natural curvature less m0z.
    pub fn section(&self) -> Section<T> {
        Section { x: self.pose.x, y: self.pose.y, phi: self.pose.z, kappa: self.natural - self.reactions.z }
    }

    /// The force (A, B) = (f0y, -f0x) that the rod carries next to the clamp.
    pub fn force(&self) -> [T; 2] {
        [self.reactions.y, -self.reactions.x]
    }

    pub fn at(&self, s: T) -> Section<T> {
        let [a, b] = self.force();
        advance(&self.section(), a, b, s)
    }

    /// [`Self::gradient_at`] with zeros in place of the derivatives by the clamp's pose and reactions: a third of the work.
    pub fn slide_at(&self, s: T) -> (Section<T>, SectionGradient<T>) {
        let ([a, b], end) = (self.force(), self.at(s));
        let (sin, cos) = end.phi.sin_cos();
        let by_s = Vector4::new(cos, sin, end.kappa, a * cos + b * sin);
        let gradient = SectionGradient {
            by_reactions: Matrix4x3::zeros(),
            #[cfg(feature = "std")]
            by_phi0: Vector4::zeros(),
            by_s,
        };
        (end, gradient)
    }

    /// The section at arc length s, with its derivatives.
    pub fn gradient_at(&self, s: T) -> (Section<T>, SectionGradient<T>) {
        let [a, b] = self.force();
        let (end, by) = advance_with_sensitivities(&self.section(), a, b, s);
        let column = |c: [T; 4]| Vector4::from(c);
        let by_reactions = Matrix4x3::from_columns(&[-column(by.by_b), column(by.by_a), -column(by.by_kappa)]);
        let gradient = SectionGradient {
            by_reactions,
            #[cfg(feature = "std")]
            by_phi0: column(by.by_phi),
            by_s: column(by.by_s),
        };
        (end, gradient)
    }

    /// Sine of the angle by which friction turns the force of a contact.
    pub fn sin_rho(&self) -> T {
        self.friction / (T::one() + self.friction * self.friction).sqrt()
    }

    /// The tangent angle of the contour where a single contact is, at a section of the rod at this angle. The force next to the clamp is that
    /// of the contact, which friction turns from the normal of the contour: one way where the solid is on the rod's left, and the
    /// other way where it is on its right.
    pub fn alpha(&self, phi: T) -> T {
        if self.friction == T::zero() {
            let [a, b] = self.force();
            return b.atan2(a);
        }
        let [a, b] = normal_part(self.force(), phi.sin_cos(), self.friction);
        b.atan2(a)
    }

    /// Derivative of that angle by the friction.
    #[cfg(feature = "std")]
    pub fn alpha_by_friction(&self, phi: T) -> T {
        let ([a, b], (sin, cos)) = (self.force(), phi.sin_cos());
        let turn = (T::one() + self.friction * self.friction).recip();
        if a * cos + b * sin < T::zero() { turn } else { -turn }
    }

    /// The phase criterion K - 2 |F| sin rho, K = kappa(0)^2 - n^2 - 2 (f0y sin phi0 + f0x cos phi0) of a rod of natural curvature n,
    /// |F| = hypot(f0x, f0y) and rho the angle of friction, and its derivatives by the reactions.
    pub fn criterion(&self) -> (T, Vector3<T>) {
        let (two, (sin, cos)) = (T::from_f64(2.0), self.pose.z.sin_cos());
        let r = &self.reactions;
        // kappa(0)^2 - n^2, which is m0z^2 for a straight rod
        let bending = r.z * (r.z - two * self.natural);
        let k = bending - two * (r.y * sin + r.x * cos);
        let by_reactions = Vector3::new(-two * cos, -two * sin, two * (r.z - self.natural));
        let (rubbing, by_force) = self.rubbing();
        (k - rubbing, by_reactions - by_force)
    }

    /// What K of a single tangential contact is, 2 |F| sin rho, and its derivatives by the reactions.
    pub fn rubbing(&self) -> (T, Vector3<T>) {
        let (r, twice) = (&self.reactions, T::from_f64(2.0) * self.sin_rho());
        let force = (r.x * r.x + r.y * r.y).sqrt();
        if twice == T::zero() || force == T::zero() {
            return (T::zero(), Vector3::zeros());
        }
        (twice * force, Vector3::new(r.x / force, r.y / force, T::zero()) * twice)
    }
}

/// Derivatives of a section (x, y, phi, kappa) of the rod. Those by x0 and y0 are trivial: the rod moves along.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SectionGradient<T = f64> {
    pub by_reactions: Matrix4x3<T>,
    #[cfg(feature = "std")]
    pub by_phi0: Vector4<T>,
    pub by_s: Vector4<T>,
}

#[cfg(feature = "std")]
impl Clamp {
    /// The sample with this pose and these reactions, SI units, for a straight rod of these units that has the same curvature at its clamp.
    pub fn sample(&self, units: Units, of: &Sample) -> Sample {
        let (pose, reactions) = self.in_units(units);
        Sample { pose, reactions, ..*of }
    }

    /// Its pose and reactions, SI units, with the moment of such a rod.
    pub fn in_units(&self, units: Units) -> (Pose, Reactions) {
        let (p, r) = (&self.pose, &self.reactions);
        let pose = Pose { x: p.x * units.length, y: p.y * units.length, phi: p.z };
        let reactions =
            Reactions { f0x: r.x * units.force, f0y: r.y * units.force, m0z: (r.z - self.natural) * units.moment };
        (pose, reactions)
    }
}

#[cfg(feature = "std")]
impl SectionGradient {
    /// Rate of the section at a fixed arc length where the clamp and its reactions change at this rate.
    pub fn rate(&self, rate: &Clamp) -> Vector4<f64> {
        let carried = Vector4::new(rate.pose.x, rate.pose.y, 0.0, 0.0);
        carried + self.by_phi0 * rate.pose.z + self.by_reactions * rate.reactions
    }
}
