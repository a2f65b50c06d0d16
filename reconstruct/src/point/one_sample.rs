//! What one sample tells of the contacts of any rod, on any clamp: tapered, of sections, bent at rest, on springs.

use super::bent::Bent;
use super::moment_zero::is_free;
use super::no_contact::NoContact;
use super::single::dimensionless;
use super::touch::Touch;
use crate::numeric::{CHANCE, variance};
use nalgebra::{Matrix2, Matrix3, SMatrix, SVector};
use rod_core::{Cut, PhysicalRod, Pose, Reactions, RodModel, Units};

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
    contacts_of_readings(&Bent::new(rod, &clamp), clamp.reactions.norm(), &covariance, units)
}

/// A rod whose shape up to its first contact follows from N readings, dimensionless.
pub(super) trait Felt<const N: usize> {
    /// The rod.
    fn model(&self) -> &impl RodModel;
    /// The force (A, B) that its contacts push with, and its derivatives by the readings.
    fn force(&self) -> ([f64; 2], [[f64; 2]; N]);
    /// (x, y, phi, moment) at an arc length, and its derivatives by the readings.
    fn by_readings(&self, s: f64) -> (Cut, [[f64; 4]; N]);
    /// The zeros of the moment, a little beyond the tip too.
    fn moment_zeros(&self) -> Vec<f64>;
}

impl<M: RodModel> Felt<3> for Bent<'_, M> {
    fn model(&self) -> &impl RodModel {
        self.model
    }

    fn force(&self) -> ([f64; 2], [[f64; 2]; 3]) {
        ([self.a, self.b], [[0.0, -1.0], [1.0, 0.0], [0.0, 0.0]])
    }

    fn by_readings(&self, s: f64) -> (Cut, [[f64; 4]; 3]) {
        let (at, columns, _) = self.by_reactions(s);
        (at, columns)
    }

    fn moment_zeros(&self) -> Vec<f64> {
        self.zeros().collect()
    }
}

/// What readings of this `size` tell of the contacts of a rod that is not free.
pub(super) fn contacts_of_readings<const N: usize>(
    felt: &impl Felt<N>,
    size: f64,
    covariance: &SMatrix<f64, N, N>,
    units: Units,
) -> Result<OneSample, NoContact> {
    let rounding = (EXACT * (1.0 + size)).powi(2);
    let exact = covariance + SMatrix::from_diagonal_element(rounding);
    let zeros = felt.moment_zeros();
    let found: Vec<ZeroOfMoment> = zeros.iter().map(|zero| zero_of_moment(felt, *zero, &exact)).collect();
    let touch = |s: f64, slides: bool| touch(felt, s, slides, covariance).in_units(units);
    if let Some(tip) = found.iter().find(|zero| zero.is_at_tip() && zero.presses()) {
        return Ok(OneSample::Tip(touch(tip.s, true)));
    }
    // where the force acts along the end of the rod, the moment vanishes there without a change of sign
    if is_free_of_moment(felt, 1.0, &exact) && zero_of_moment(felt, 1.0, &exact).presses() {
        return Ok(OneSample::Tip(touch(1.0, false)));
    }
    let first = *zeros.first().ok_or(NoContact::NoMomentZero)?;
    let tangent = found.iter().find(|zero| zero.s < 1.0 && zero.is_tangential());
    let several = || OneSample::Several(touch(first, true));
    Ok(tangent.map_or_else(several, |zero| OneSample::Tangent(touch(zero.s, true))))
}

/// A zero of the moment.
struct ZeroOfMoment {
    s: f64,
    s_noise: f64,
    /// Sine of the angle from the contour to the rod: positive at the tip, 0 at a tangential contact.
    pressing: f64,
    pressing_noise: f64,
}

impl ZeroOfMoment {
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

fn zero_of_moment<const N: usize>(felt: &impl Felt<N>, s: f64, covariance: &SMatrix<f64, N, N>) -> ZeroOfMoment {
    let ((at, columns), ([a, b], by_force)) = (felt.by_readings(s), felt.force());
    let (rate, force) = (moment_rate(&at, [a, b]), a.hypot(b));
    // the zero slides along the rod so that the moment there stays 0
    let by_s = SVector::from(columns.map(|column| -column[3] / rate));
    let turn = SVector::from(by_force.map(|[by_a, by_b]| (a * by_b - b * by_a) / (force * force)));
    let bend = felt.model().curvature_at(s, 0.0);
    let by_angle = SVector::from(columns.map(|column| column[2])) + by_s * bend - turn;
    let (pressing, tilt) = (at.phi - b.atan2(a)).sin_cos();
    let noise = |gradient: &SVector<f64, N>| CHANCE * variance(gradient, covariance).sqrt();
    ZeroOfMoment { s, s_noise: noise(&by_s), pressing, pressing_noise: noise(&(by_angle * tilt)) }
}

/// Whether the moment at an arc length is within its noise.
fn is_free_of_moment<const N: usize>(felt: &impl Felt<N>, s: f64, covariance: &SMatrix<f64, N, N>) -> bool {
    let (at, columns) = felt.by_readings(s);
    let gradient = SVector::from(columns.map(|column| column[3]));
    at.moment.abs() <= CHANCE * variance(&gradient, covariance).sqrt()
}

/// The contact there, dimensionless; it `slides` along the rod with the readings so that the moment there stays 0.
fn touch<const N: usize>(felt: &impl Felt<N>, s: f64, slides: bool, covariance: &SMatrix<f64, N, N>) -> Touch {
    let ((at, columns), ([a, b], _)) = (felt.by_readings(s), felt.force());
    let (rate, (sin, cos)) = (moment_rate(&at, [a, b]), at.phi.sin_cos());
    let columns = columns.map(|[x, y, _, moment]| {
        let slide = if slides { -moment / rate } else { 0.0 };
        [x + cos * slide, y + sin * slide]
    });
    let position = SMatrix::<f64, 2, N>::from_fn(|i, c| columns[c][i]);
    let covariance = position * covariance * position.transpose();
    Touch { s, x: at.x, y: at.y, alpha: b.atan2(a), force: a.hypot(b), covariance, systematic: Matrix2::zeros() }
}

/// How the moment changes along the rod.
fn moment_rate(at: &Cut, [a, b]: [f64; 2]) -> f64 {
    a * at.phi.cos() + b * at.phi.sin()
}
