//! Where the moment along the rod vanishes: the contact point of a single contact.

use super::clamp::Clamp;
use super::no_contact::NoContact;
use super::touch::Touch;
use crate::numeric::{Number, propagate_covariance};
use core::cmp::Ordering::Equal;
use nalgebra::{Matrix2, Matrix2x3, Matrix3, Vector3};
use rod_core::{Section, inflection, walk};

/// Standard deviations within which a difference counts as noise. Larger: more weak contacts count as a free rod, and fewer
/// points on the rod are called beyond its tip.
pub(super) const NOISE_SIGMAS: f64 = 4.0;

/// Newton steps from where the curvature is 0 to where it is the natural one; a natural curvature of 0.1 / L takes 3 to rounding.
const NEWTON_STEPS: usize = 4;
/// A step from which on the next one is below rounding, rod lengths.
const SETTLED: f64 = 1e-9;
/// Largest distance between the two, rod lengths. Larger: steps that do not converge give contact points anywhere.
const FARTHEST: f64 = 0.2;

/// Natural curvature (1 / L) above which the zeros of the moment are followed along the rod: below, and so for all that a calibration
/// estimates, the first is near where the curvature vanishes.
const BENT: f64 = 0.2;
/// Length (L) of the steps in which they are, and their number, which ends beyond the tip. Two zeros within one step may be missed.
const STEP: f64 = 1.0 / 64.0;
const STEPS: usize = 96;

/// Whether the reactions are within the noise of zero in each channel.
pub(crate) fn is_free<T: Number>(clamp: &Clamp<T>, covariance: &Matrix3<T>) -> bool {
    let sigmas = T::from_f64(NOISE_SIGMAS);
    (0..3).all(|c| clamp.reactions[c].abs() <= sigmas * covariance[(c, c)].max(T::zero()).sqrt())
}

fn is_bent<T: Number>(clamp: &Clamp<T>) -> bool {
    clamp.natural.abs() > T::from_f64(BENT)
}

/// Where the moment of a rod that is bent at rest vanishes, from the clamp on: to the square of a step.
fn along<T: Number>(clamp: &Clamp<T>) -> impl Iterator<Item = T> {
    let ([a, b], step, natural) = (clamp.force(), T::from_f64(STEP), clamp.natural);
    let start = clamp.section();
    let mut from = start.kappa - natural;
    walk(&start, a, b, T::from_f64(STEP * STEPS as f64), STEPS).enumerate().filter_map(move |(k, section)| {
        let (before, to) = (from, section.kappa - natural);
        from = to;
        // a zero at the end of a step is of that step
        (before != T::zero() && before * to <= T::zero())
            .then(|| step * (T::from_f64(k as f64) + before / (before - to)))
    })
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
    /// The same by the clamp's angle.
    #[cfg(feature = "std")]
    pub by_phi0: Vector3<T>,
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
        let s = if is_bent(clamp) { along(clamp).next() } else { inflection(&clamp.section(), a, b) };
        s.and_then(|s| Self::at(clamp, s, derived)).ok_or(NoContact::NoMomentZero)
    }

    /// The zero nearest to the tip, if that is a later one than this, the first. A rod that is pushed into a notch, or on end,
    /// buckles, and its moment vanishes several times. Along a segment the zeros are evenly spaced.
    #[cfg(feature = "std")]
    pub fn by_tip(&self, clamp: &Clamp<T>) -> Option<Self> {
        self.later(clamp, true)
    }

    /// The same, with derivatives (`derived`) or with zeros in their place.
    pub(super) fn later(&self, clamp: &Clamp<T>, derived: bool) -> Option<Self> {
        if is_bent(clamp) {
            let from_tip = |s: &T| (*s - T::one()).abs();
            let nearest = along(clamp).skip(1).min_by(|u, v| from_tip(u).partial_cmp(&from_tip(v)).unwrap_or(Equal))?;
            return if from_tip(&nearest) < from_tip(&self.s) { Self::at(clamp, nearest, derived) } else { None };
        }
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

    /// The zero at arc length `s`, or, for a rod with natural curvature, the point near it where the curvature is that; none where the
    /// curvature is stationary.
    fn at(clamp: &Clamp<T>, mut s: T, derived: bool) -> Option<Self> {
        let [a, b] = clamp.force();
        if clamp.natural != T::zero() {
            let start = s;
            for _ in 0..NEWTON_STEPS {
                let (section, gradient) = clamp.slide_at(s);
                let step = (section.kappa - clamp.natural) / gradient.by_s[3];
                s -= step;
                // the next step would be about the square of this one
                if step.abs() <= T::from_f64(SETTLED) {
                    break;
                }
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
        #[cfg(feature = "std")]
        let by_phi0 = {
            let at_s = gradient.by_phi0;
            at_s.fixed_rows::<3>(0) - slide * (at_s[3] / kappa_by_s)
        };
        let (force, alpha) = ((a * a + b * b).sqrt(), clamp.alpha(section.phi));
        Some(Self {
            s,
            section,
            force,
            alpha,
            s_by_reactions,
            by_reactions,
            #[cfg(feature = "std")]
            by_phi0,
        })
    }

    /// The contact there, dimensionless.
    pub fn touch(&self, covariance: &Matrix3<T>) -> Touch<T> {
        let jacobian: Matrix2x3<T> = self.by_reactions.fixed_rows::<2>(0).into_owned();
        let Section { x, y, .. } = self.section;
        let covariance: Matrix2<T> = propagate_covariance(&jacobian, covariance);
        let systematic = Matrix2::zeros();
        Touch { s: self.s, x, y, alpha: self.alpha, force: self.force, covariance, systematic }
    }

    /// Velocity of this point where the clamp and its reactions change at this rate.
    #[cfg(feature = "std")]
    pub fn velocity(&self, rate: &Clamp<T>) -> nalgebra::Vector2<T> {
        let moved = self.by_reactions * rate.reactions + self.by_phi0 * rate.pose.z;
        nalgebra::Vector2::new(rate.pose.x + moved.x, rate.pose.y + moved.y)
    }

    /// The parts of a velocity across the contour, into the solid, and along it.
    #[cfg(feature = "std")]
    pub fn speeds(&self, velocity: &nalgebra::Vector2<T>) -> [T; 2] {
        let normal = self.normal();
        [normal.dot(velocity), normal.y * velocity.x - normal.x * velocity.y]
    }

    /// Normal of the contour there, into the solid.
    #[cfg(feature = "std")]
    pub fn normal(&self) -> nalgebra::Vector2<T> {
        let (sin, cos) = self.alpha.sin_cos();
        nalgebra::Vector2::new(-sin, cos)
    }
}
