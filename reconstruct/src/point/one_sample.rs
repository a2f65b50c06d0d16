//! What one sample tells of the contacts of any rod, on any clamp: tapered, of sections, bent at rest, on springs.

use super::bent::Bent;
use super::moment_zero::is_free;
use super::no_contact::NoContact;
use super::single::dimensionless;
use super::touch::Touch;
use crate::numeric::propagated;
use nalgebra::{Matrix2, Matrix2x3, Matrix3, Vector3};
use rod_core::{PhysicalRod, Pose, Reactions, RodModel};

/// Standard deviations within which a difference counts as noise.
const SIGMAS: f64 = 4.0;
/// What exact reactions are off by, relative to 1 + |reactions|: what solver and rounding leave.
const EXACT: f64 = 1e-10;

/// What the reactions of one sample tell of the contacts.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum OneSample {
    /// No force beyond the noise: the rod is free.
    Free,
    /// One contact, at the tip.
    Tip(Touch),
    /// One contact along the rod's side. Of a rod that is uniform from the first of two such contacts on, the reactions to both are of
    /// this kind too.
    Tangent(Touch),
    /// No single contact gives such reactions: there are several, or reactions, pose or rod have an error. The point is where the moment
    /// vanishes first, which is no contact.
    Several(Touch),
}

impl OneSample {
    /// The point at which the moment vanishes, if the rod is not free.
    pub fn touch(&self) -> Option<Touch> {
        match self {
            Self::Free => None,
            Self::Tip(touch) | Self::Tangent(touch) | Self::Several(touch) => Some(*touch),
        }
    }
}

/// A name in small letters, such as `tip`.
impl std::fmt::Display for OneSample {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(match self {
            Self::Free => "free",
            Self::Tip(_) => "tip",
            Self::Tangent(_) => "tangent",
            Self::Several(_) => "several",
        })
    }
}

/// What the `reactions` (N, N m) of any `rod` tell, the support of its clamp at `pose` (m, radians): whether one contact gives them, of which
/// kind, and where. The `covariance` of (f0x, f0y, m0z), in N^2, N^2 m, N^2 m^2, tells how far they may be off; zero where they are exact.
///
/// A single contact is where the moment vanishes, with alpha = atan2(-f0x, f0y). There the pair (arc length, angle between rod and
/// contour) tells the kind, whatever the rod is: at the tip s = L, along the side the angle is 0 (Merker et al. 2020, section 3, for a
/// uniform straight rod, whose criterion K is the same as the angle). Neither is fulfilled where there are two contacts, unless the rod is
/// uniform from the first one on.
///
/// The base of a rod on springs is where the reactions put it. Zeros of the moment are bracketed in steps of 1/64 of the rod's length, and
/// found to rounding; the covariance follows from exact derivatives. With exact reactions the point is exact to 1e-12 of the rod's length
/// unless the force almost vanishes.
///
/// ```
/// use nalgebra::Matrix3;
/// use rod_core::{GeneralElastica, Load, Pose, Rod};
/// use rod_reconstruct::{OneSample, one_sample};
/// let whisker = Rod::tapered(0.04, 1e-4, 2e-5, 3e9)?.with_natural_curvature(10.0)?;
/// let clamp = Pose { x: 0.0, y: 0.0, phi: 1.5 };
/// let load = Load { s: 0.04, force: 1e-6, alpha: 1.2 };
/// let bent = GeneralElastica::under_loads(&whisker, whisker.units(), clamp, &[load])?.0;
/// let OneSample::Tip(touch) = one_sample(&whisker, clamp, bent.reactions(), &Matrix3::zeros())? else { return Err("no tip".into()) };
/// assert!((touch.x - bent.at(0.04)?.x).abs() < 1e-14 && (touch.force - 1e-6).abs() < 1e-18);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`NoContact::NotFinite`], and [`NoContact::NoMomentZero`] where the moment vanishes nowhere along the rod.
pub fn one_sample<R: PhysicalRod>(
    rod: &R,
    pose: Pose,
    reactions: Reactions,
    covariance: &Matrix3<f64>,
) -> Result<OneSample, NoContact> {
    let units = rod.units();
    let (clamp, covariance) = dimensionless(units, pose, reactions, covariance)?;
    if is_free(&clamp, &covariance) {
        return Ok(OneSample::Free);
    }
    let bent = Bent::new(rod, &clamp);
    let rounding = (EXACT * (1.0 + clamp.reactions.norm())).powi(2);
    let exact = covariance + Matrix3::from_diagonal_element(rounding);
    let zeros: Vec<f64> = bent.zeros().collect();
    let places: Vec<Place> = zeros.iter().map(|zero| bent.place(*zero, &exact)).collect();
    let touch = |s: f64| bent.touch(s, true, &covariance).in_units(units);
    if let Some(tip) = places.iter().find(|place| place.is_at_tip() && place.presses()) {
        return Ok(OneSample::Tip(touch(tip.s)));
    }
    // where the force acts along the end of the rod, the moment vanishes there without a change of sign
    if bent.is_free_of_moment(1.0, &exact) && bent.place(1.0, &exact).presses() {
        return Ok(OneSample::Tip(bent.touch(1.0, false, &covariance).in_units(units)));
    }
    let first = *zeros.first().ok_or(NoContact::NoMomentZero)?;
    let tangent = places.iter().find(|place| place.s < 1.0 && place.is_tangential());
    Ok(tangent.map_or_else(|| OneSample::Several(touch(first)), |place| OneSample::Tangent(touch(place.s))))
}

/// A zero of the moment.
struct Place {
    s: f64,
    s_noise: f64,
    /// Sine of the angle from the contour to the rod: positive at the tip, 0 at a tangential contact.
    pressing: f64,
    pressing_noise: f64,
}

impl Place {
    fn is_at_tip(&self) -> bool {
        (self.s - 1.0).abs() <= self.s_noise
    }
    fn presses(&self) -> bool {
        self.pressing >= -self.pressing_noise
    }
    fn is_tangential(&self) -> bool {
        self.pressing.abs() <= self.pressing_noise
    }
}

impl<M: RodModel> Bent<'_, M> {
    fn place(&self, s: f64, covariance: &Matrix3<f64>) -> Place {
        let (at, columns, _) = self.by_reactions(s);
        let (rate, force) = (self.moment_rate(&at), self.a.hypot(self.b));
        // the zero slides along the rod so that the moment there stays 0
        let by_s = Vector3::from(columns.map(|column| -column[3] / rate));
        let turn = Vector3::new(-self.a, -self.b, 0.0) / (force * force);
        let bend = self.model.curvature_at(s, 0.0);
        let by_angle = Vector3::from(columns.map(|column| column[2])) + by_s * bend - turn;
        let (pressing, tilt) = (at.phi - self.alpha()).sin_cos();
        let noise = |gradient: Vector3<f64>| SIGMAS * propagated(&gradient.transpose(), covariance).x.sqrt();
        Place { s, s_noise: noise(by_s), pressing, pressing_noise: noise(by_angle * tilt) }
    }

    /// Whether the moment at an arc length is within its noise.
    fn is_free_of_moment(&self, s: f64, covariance: &Matrix3<f64>) -> bool {
        let (at, columns, _) = self.by_reactions(s);
        let by_reactions = Vector3::from(columns.map(|column| column[3]));
        at.moment.abs() <= SIGMAS * propagated(&by_reactions.transpose(), covariance).x.sqrt()
    }

    /// The contact there, dimensionless; it `slides` along the rod with the reactions so that the moment there stays 0.
    fn touch(&self, s: f64, slides: bool, covariance: &Matrix3<f64>) -> Touch {
        let (at, columns, _) = self.by_reactions(s);
        let (rate, (sin, cos)) = (self.moment_rate(&at), at.phi.sin_cos());
        let columns = columns.map(|[x, y, _, moment]| {
            let slide = if slides { -moment / rate } else { 0.0 };
            [x + cos * slide, y + sin * slide]
        });
        let position = Matrix2x3::from_fn(|i, c| columns[c][i]);
        let covariance = propagated(&position, covariance);
        let force = self.a.hypot(self.b);
        Touch { s, x: at.x, y: at.y, alpha: self.alpha(), force, covariance, systematic: Matrix2::zeros() }
    }
}
