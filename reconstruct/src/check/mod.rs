//! Whether a recording can be of the rod it is said to be of: a check by the physics.
//!
//! Wherever the last contact is tangential, whatever the object, the phase criterion vanishes: m0z^2 = 2 EI (f0y sin
//! phi0 + f0x cos phi0). `bins` averages the samples, `line` finds the straight line among them without knowing any
//! phase, and `finding` is what its slope and intercept suggest.

mod bins;
mod finding;
mod line;

pub use finding::Finding;
pub use line::TangentialLine;

use crate::point::single::{NoContact, single};
use crate::point::touch::Touch;
use bins::{Bin, bins};
use rod_core::{Reactions, Rod, Sample};

/// How far beyond the tip, in lengths of the rod, a contact may seem to be, and how far above 0, in parts of m0z^2, the
/// phase criterion, before the rod is blamed for it.
const SLACK: f64 = 0.02;

/// What the physics says of a recording, SI units if the recording's are.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Plausibility {
    /// The line of the tangential contacts; none where less than a fifth of the scan in contact lies on one.
    pub line: Option<TangentialLine>,
    /// Shares of the scan in contact by what a single contact makes of them.
    pub shares: Shares,
    /// What all this suggests; nothing where there is nothing to say.
    pub findings: Vec<Finding>,
}

/// Shares of the scan in contact by what a single contact makes of them; they add up to 1 unless the rod is free all
/// along. Several contacts are mostly taken for a single one elsewhere: they hardly count among the others.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shares {
    /// There is a place for it on the rod.
    pub explained: f64,
    /// It would be beyond the tip.
    pub beyond_tip: f64,
    /// It would have to pull.
    pub pulling: f64,
    /// The moment vanishes nowhere.
    pub no_moment_zero: f64,
}

impl Plausibility {
    /// Whether recording, units and rod fit together, as far as can be seen: no finding says that they do not.
    pub fn fits(&self) -> bool {
        !self.findings.iter().any(Finding::is_misfit)
    }
}

/// Checks by the physics whether samples (of use or not; only those that are numbers are looked at) can be of this rod.
/// No contact phase is needed, so that it works where wrong units make all of them wrong. Nothing is corrected:
/// friction bends the line, too.
///
/// Accuracy: of noise-free scans the slope is EI to rounding. Of the paper's nine scans with noise of 2.5 mN and 0.06
/// mN m (85,000 samples each) it is EI to 0.02 %; with a tenth of the samples, contacts of the tip that cannot be told
/// from tangential ones make it too large by 0.3 %, which the standard error does not tell.
///
/// ```
/// use rod_core::{Pose, Reactions, Rod};
/// use rod_reconstruct::{Sample, plausibility};
/// let rod = Rod::new(0.1, 6.3e-4)?; // m, N m^2
/// // Tangential contacts of growing force, the clamp upright, and the moment given in N mm.
/// let sample = |k: i32| {
///     let (x, f0y) = (1e-3 * f64::from(k), 1e-3 * f64::from(k));
///     let m0z = -(2.0 * rod.bending_stiffness() * f0y).sqrt();
///     let pose = Pose { x, y: 0.0, phi: std::f64::consts::FRAC_PI_2 };
///     Sample::new(pose, Reactions { f0x: 0.0, f0y, m0z: 1e3 * m0z })
/// };
/// let samples: Vec<Sample> = (1..100).map(sample).collect();
/// let check = plausibility(&rod, &samples);
/// assert!(!check.fits());
/// let said = check.findings[0].to_string();
/// assert!(said.contains("1.000e6 times the bending stiffness, as if moments are in N mm"), "{said}");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn plausibility(rod: &Rod, samples: &[Sample]) -> Plausibility {
    let bins = bins(samples);
    if bins.is_empty() {
        return Plausibility { findings: vec![Finding::NoContact], ..Plausibility::default() };
    }
    let found = line::find(&bins);
    let shares = Shares::of(rod, &bins);
    let line = found.as_ref().map(|found| found.line);
    let findings = finding::findings(rod, samples, &bins, found.as_ref(), shares);
    Plausibility { line, shares, findings }
}

impl Shares {
    fn of(rod: &Rod, bins: &[Bin]) -> Self {
        let one = 1.0 / bins.len() as f64;
        let mut shares = Self::default();
        for bin in bins {
            match contact(rod, bin, bin.reactions) {
                Ok(_) => shares.explained += one,
                Err(NoContact::BeyondTip(_)) => shares.beyond_tip += one,
                Err(NoContact::Pulling(_)) => shares.pulling += one,
                Err(_) => shares.no_moment_zero += one,
            }
        }
        shares
    }
}

/// The single contact of a bin with these reactions, if a rod about as long and as stiff has one.
fn contact(rod: &Rod, bin: &Bin, reactions: Reactions) -> Result<Touch, NoContact> {
    match single(rod, bin.pose, reactions, &bin.covariance) {
        Err(NoContact::BeyondTip(touch)) if touch.s <= (1.0 + SLACK) * rod.length() => Ok(touch),
        Err(NoContact::Pulling(touch)) => {
            let excess = reactions.phase_criterion(bin.pose.phi, rod.bending_stiffness());
            if excess <= SLACK * bin.square { Ok(touch) } else { Err(NoContact::Pulling(touch)) }
        }
        other => other,
    }
}
