//! One contact from one sample: the rod, followed from its clamp to where it is straight (Will 2014; Merker et al. 2020,
//! section 3), in closed form and with exact derivatives.

use crate::numeric::number::Number;
use crate::point::clamp::{Clamp, spread};
use crate::point::touch::Touch;
use nalgebra::{Matrix2, Matrix2x3, Matrix3, Vector3};
use rod_core::{Pose, Reactions, Rod, Section, Units, inflection};

/// How far beyond the tip, in lengths of the rod, or how much against the phase criterion, dimensionless, is rounding.
const SLACK: f64 = 1e-9;
/// The same in roundings of the numbers computed in, which is more than the above in `f32` only.
const ROUNDINGS: f64 = 400.0;
/// How many standard deviations are noise.
pub(crate) const SIGMAS: f64 = 4.0;

/// Why no single contact can have caused what the clamp felt. Not a failure: an answer, with what there is of a contact.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NoContact<T: Number = f64> {
    /// The clamp carries no force beyond the noise.
    #[error("no force: the rod is free")]
    Free,
    /// The curvature keeps its sign however long the rod: no place is free of moment.
    #[error("the moment vanishes nowhere along the rod")]
    NoMomentZero,
    /// The moment vanishes beyond the tip only, at the point given.
    #[error("the moment vanishes at {} m, beyond the tip", .0.s)]
    BeyondTip(Touch<T>),
    /// The rod at the point given leaves the object instead of pressing on it: the contact would have to pull.
    #[error("the contact at {} m would pull at the rod", .0.s)]
    Pulling(Touch<T>),
    /// Pose, reactions or covariance are no numbers.
    #[error("pose and reactions are not finite numbers")]
    NotFinite,
}

impl<T: Number> NoContact<T> {
    /// The point where the moment vanishes all the same, if it does: what a reconstruction that knows single contacts only would
    /// take for the contact.
    pub fn touch(&self) -> Option<Touch<T>> {
        match self {
            Self::BeyondTip(touch) | Self::Pulling(touch) => Some(*touch),
            _ => None,
        }
    }
}

/// The contact that bends `rod`, clamped at `pose` (m, radians), so that its clamp feels `reactions` (N, N m), if a single
/// one does: position, arc length, tangent angle of the contour and force, and the covariance of the position that follows
/// from the `covariance` of (f0x, f0y, m0z), in N^2, N^2 m, N^2 m^2; zero where that is not known.
///
/// A = f0y, B = -f0x, kappa(0) = -m0z; the contact is where the curvature vanishes first, alpha = atan2(B, A) (Merker et
/// al. 2020, eq. 10 and 18); but at the tip where the criterion K < 0 excludes a tangential contact and the curvature
/// vanishes at the tip once more, as it does of a rod that buckles in a notch. Exact but for rounding: of reactions exact
/// to rounding the point is too, 1e-13 of the rod's length unless the force almost vanishes. No allocation.
///
/// In `f32` the point is within 1e-6 of the rod's length of that in `f64` in all samples of phases A and B of the paper's scans
/// (median 1e-7), and under random loads within 5e-6 in 99 % and within 20 standard deviations of what rounding the
/// reactions to `f32` makes in all. Where derivatives are not asked for, with a covariance of zero, half of the work is saved.
///
/// ```
/// use nalgebra::Matrix3;
/// use rod_core::{Elastica, Load, Pose, Rod};
/// let rod = Rod::new(0.1, 6.3e-4)?; // m, N m^2
/// let clamp = Pose { x: 0.0, y: 0.0, phi: 1.5 };
/// let bent = Elastica::under_loads(rod.units(), clamp, &[Load { s: 0.08, force: 0.02, alpha: 1.2 }])?.0;
/// let found = rod_reconstruct::single(&rod, clamp, bent.reactions(), &Matrix3::zeros())?;
/// assert!((found.s - 0.08).abs() < 1e-14 && (found.x - bent.at(0.08).x).abs() < 1e-15);
/// assert!((found.alpha - 1.2).abs() < 1e-13 && (found.force - 0.02).abs() < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`NoContact`], which is as good an answer: no single contact fits, and why.
pub fn single<T: Number>(
    rod: &Rod<T>,
    pose: Pose<T>,
    reactions: Reactions<T>,
    covariance: &Matrix3<T>,
) -> Result<Touch<T>, NoContact<T>> {
    let (one, slack, sigmas) = (T::one(), T::from_f64(SLACK + ROUNDINGS * T::EPSILON), T::from_f64(SIGMAS));
    let units = rod.units();
    let (clamp, covariance) = dimensionless(units, pose, reactions, covariance)?;
    // without noise nobody asks for derivatives, which are most of the work
    let noisy = covariance.iter().any(|v| *v != T::zero());
    let first = MomentZero::first(&clamp, &covariance, noisy)?;
    let noise = |gradient: &Vector3<T>| {
        if noisy { sigmas * spread(&gradient.transpose(), &covariance).x.sqrt() } else { T::zero() }
    };
    let beyond = |found: &MomentZero<T>| noise(&found.s_by_reactions) + slack;
    let (k, gradient) = clamp.criterion();
    let excess = noise(&gradient) + slack * (one + first.force);
    let tip = if k < -excess { first.later(&clamp, noisy) } else { None };
    let found = tip.filter(|tip| (tip.s - one).abs() <= beyond(tip)).unwrap_or(first);
    let touch = found.touch(&covariance).in_units(units);
    if found.s > one + beyond(&found) {
        return Err(NoContact::BeyondTip(touch));
    }
    if k > excess { Err(NoContact::Pulling(touch)) } else { Ok(touch) }
}

/// What the clamp feels and how well that is known, dimensionless, if these are numbers.
pub(crate) fn dimensionless<T: Number>(
    units: Units<T>,
    pose: Pose<T>,
    reactions: Reactions<T>,
    covariance: &Matrix3<T>,
) -> Result<(Clamp<T>, Matrix3<T>), NoContact<T>> {
    let clamp = Clamp::new(units, pose, reactions);
    let unit = Vector3::new(units.force, units.force, units.moment).map(T::recip);
    let covariance = Matrix3::from_fn(|i, j| unit[i] * covariance[(i, j)] * unit[j]);
    if clamp.is_finite() && covariance.iter().all(|v| v.is_finite()) {
        Ok((clamp, covariance))
    } else {
        Err(NoContact::NotFinite)
    }
}

/// Whether reactions with this covariance may be none.
pub(crate) fn is_free<T: Number>(clamp: &Clamp<T>, covariance: &Matrix3<T>) -> bool {
    let sigmas = T::from_f64(SIGMAS);
    (0..3).all(|c| clamp.reactions[c].abs() <= sigmas * covariance[(c, c)].max(T::zero()).sqrt())
}

/// Where the moment vanishes first, dimensionless, with derivatives by the reactions.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MomentZero<T = f64> {
    pub s: T,
    pub section: Section<T>,
    pub force: T,
    /// Tangent angle of the contour.
    pub alpha: T,
    pub s_by_reactions: Vector3<T>,
    /// Of (x, y, phi) at this point, which moves along the rod.
    pub by_reactions: Matrix3<T>,
}

impl<T: Number> MomentZero<T> {
    /// Of a rod whose reactions have this covariance: within it they may be none.
    #[cfg(feature = "std")]
    pub fn of(clamp: &Clamp<T>, covariance: &Matrix3<T>) -> Result<Self, NoContact<T>> {
        Self::first(clamp, covariance, true)
    }

    /// The same, with derivatives or with zeros in their place.
    fn first(clamp: &Clamp<T>, covariance: &Matrix3<T>, derived: bool) -> Result<Self, NoContact<T>> {
        if is_free(clamp, covariance) {
            return Err(NoContact::Free);
        }
        let [a, b] = clamp.force();
        let s = inflection(&clamp.section(), a, b).ok_or(NoContact::NoMomentZero)?;
        Self::at(clamp, s, derived).ok_or(NoContact::NoMomentZero)
    }

    /// The zero nearest to the tip, where it is a later one than this, the first: a rod pushed into a notch, or on end,
    /// buckles and is straight several times. Along a segment its zeros are evenly spaced.
    #[cfg(feature = "std")]
    pub fn by_tip(&self, clamp: &Clamp<T>) -> Option<Self> {
        self.later(clamp, true)
    }

    /// The same, with derivatives or with zeros in their place.
    fn later(&self, clamp: &Clamp<T>, derived: bool) -> Option<Self> {
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
        // also where it is no number
        if !(later >= T::one() && later.is_finite()) {
            return None;
        }
        Self::at(clamp, self.s + later * spacing, derived)
    }

    /// The zero that the tip would be at, if it alone were in contact.
    #[cfg(feature = "std")]
    pub fn of_tip(clamp: &Clamp<T>) -> Result<Self, NoContact<T>> {
        let first = Self::of(clamp, &Matrix3::zeros())?;
        Ok(first.by_tip(clamp).unwrap_or(first))
    }

    /// Of a zero at arc length `s`.
    fn at(clamp: &Clamp<T>, s: T, derived: bool) -> Option<Self> {
        let [a, b] = clamp.force();
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
        let covariance: Matrix2<T> = spread(&jacobian, covariance);
        Touch { s: self.s, x, y, alpha: self.alpha, force: self.force, covariance }
    }

    /// Normal of the contour there, into the solid.
    #[cfg(feature = "std")]
    pub fn normal(&self) -> nalgebra::Vector2<T> {
        let (sin, cos) = self.alpha.sin_cos();
        nalgebra::Vector2::new(-sin, cos)
    }
}
