//! Where the moment along the rod vanishes: the contact point of a single contact.

use super::clamp::Clamp;
use super::no_contact::NoContact;
use super::touch::Touch;
use crate::numeric::{Number, propagated};
use nalgebra::{Matrix2, Matrix2x3, Matrix3, Vector3};
use rod_core::{Section, inflection};

/// Standard deviations within which a difference counts as noise. Larger: more weak contacts count as a free rod, and fewer
/// points on the rod are called beyond its tip.
pub(super) const NOISE_SIGMAS: f64 = 4.0;

/// Newton steps from where the curvature is 0 to where it is the natural one; a natural curvature of 0.1 / L takes 3 to rounding.
const NEWTON_STEPS: usize = 4;
/// Largest distance between the two, rod lengths. Larger: steps that do not converge give contact points anywhere.
const FARTHEST: f64 = 0.2;

/// Whether the reactions are within the noise of zero in each channel.
pub(super) fn is_free<T: Number>(clamp: &Clamp<T>, covariance: &Matrix3<T>) -> bool {
    let sigmas = T::from_f64(NOISE_SIGMAS);
    (0..3).all(|c| clamp.reactions[c].abs() <= sigmas * covariance[(c, c)].max(T::zero()).sqrt())
}

/// A cross-section without moment, dimensionless, with derivatives by the reactions.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MomentZero<T = f64> {
    pub s: T,
    pub section: Section<T>,
    pub force: T,
    /// Tangent angle of the contour.
    pub alpha: T,
    pub s_by_reactions: Vector3<T>,
    /// Derivatives of (x, y, phi) at this point, which moves along the rod with the reactions.
    pub by_reactions: Matrix3<T>,
}

impl<T: Number> MomentZero<T> {
    /// The first zero from the clamp on, unless the reactions are within the noise of zero.
    #[cfg(feature = "std")]
    pub fn of(clamp: &Clamp<T>, covariance: &Matrix3<T>) -> Result<Self, NoContact<T>> {
        Self::first(clamp, covariance, true)
    }

    /// The same, with derivatives (`derived`) or with zeros in their place.
    pub(super) fn first(clamp: &Clamp<T>, covariance: &Matrix3<T>, derived: bool) -> Result<Self, NoContact<T>> {
        if is_free(clamp, covariance) {
            return Err(NoContact::Free);
        }
        let [a, b] = clamp.force();
        let s = inflection(&clamp.section(), a, b).ok_or(NoContact::NoMomentZero)?;
        Self::at(clamp, s, derived).ok_or(NoContact::NoMomentZero)
    }

    /// The zero nearest to the tip, if that is a later one than this, the first. A rod that is pushed into a notch, or on end,
    /// buckles, and its moment vanishes several times. Along a segment the zeros are evenly spaced.
    #[cfg(feature = "std")]
    pub fn by_tip(&self, clamp: &Clamp<T>) -> Option<Self> {
        self.later(clamp, true)
    }

    /// The same, with derivatives (`derived`) or with zeros in their place.
    pub(super) fn later(&self, clamp: &Clamp<T>, derived: bool) -> Option<Self> {
        // the spacing is no less than the first zero's arc length
        if self.s * T::from_f64(1.5) > T::one() {
            return None;
        }
        let [a, b] = clamp.force();
        let start = clamp.section();
        // the zero before the clamp is the first of the rod gone backwards
        let back = Section { phi: start.phi + T::from_f64(core::f64::consts::PI), kappa: -start.kappa, ..start };
        let spacing = self.s + inflection(&back, -a, -b)?;
        let later = ((T::one() - self.s) / spacing).round();
        // written so that NaN is rejected, too
        if !(later >= T::one() && later.is_finite()) {
            return None;
        }
        Self::at(clamp, self.s + later * spacing, derived)
    }

    /// The zero at which the tip would be, were it the only contact.
    #[cfg(feature = "std")]
    pub fn of_tip(clamp: &Clamp<T>) -> Result<Self, NoContact<T>> {
        let first = Self::of(clamp, &Matrix3::zeros())?;
        Ok(first.by_tip(clamp).unwrap_or(first))
    }

    /// The zero at arc length `s`, or, for a rod with natural curvature, the point near it where the curvature is that; none where the
    /// curvature is stationary.
    fn at(clamp: &Clamp<T>, mut s: T, derived: bool) -> Option<Self> {
        let [a, b] = clamp.force();
        if clamp.natural != T::zero() {
            let start = s;
            for _ in 0..NEWTON_STEPS {
                let (section, gradient) = clamp.slide_at(s);
                s -= (section.kappa - clamp.natural) / gradient.by_s[3];
            }
            // of a weak force the curvature changes too little along the rod
            let near = (s - start).abs() <= T::from_f64(FARTHEST);
            if !near {
                return None;
            }
        }
        let (section, gradient) = if derived { clamp.gradient_at(s) } else { clamp.slide_at(s) };
        let kappa_by_s = gradient.by_s[3];
        if kappa_by_s == T::zero() || !section.x.is_finite() {
            return None;
        }
        let at_s = gradient.by_reactions;
        let s_by_reactions = -at_s.row(3).transpose() / kappa_by_s;
        let slide = Vector3::new(gradient.by_s[0], gradient.by_s[1], gradient.by_s[2]);
        let by_reactions = at_s.fixed_rows::<3>(0) + slide * s_by_reactions.transpose();
        Some(Self { s, section, force: (a * a + b * b).sqrt(), alpha: b.atan2(a), s_by_reactions, by_reactions })
    }

    /// The contact there, dimensionless.
    pub fn touch(&self, covariance: &Matrix3<T>) -> Touch<T> {
        let jacobian: Matrix2x3<T> = self.by_reactions.fixed_rows::<2>(0).into_owned();
        let Section { x, y, .. } = self.section;
        let covariance: Matrix2<T> = propagated(&jacobian, covariance);
        let systematic = Matrix2::zeros();
        Touch { s: self.s, x, y, alpha: self.alpha, force: self.force, covariance, systematic }
    }

    /// Normal of the contour there, into the solid.
    #[cfg(feature = "std")]
    pub fn normal(&self) -> nalgebra::Vector2<T> {
        let (sin, cos) = self.alpha.sin_cos();
        nalgebra::Vector2::new(-sin, cos)
    }
}
