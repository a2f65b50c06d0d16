//! The check of a recording.

use super::bins::bins;
use super::finding::Finding;
use super::findings::findings;
use super::line::{TangentialLine, line_of};
use super::shares::Shares;
use rod_core::{Rod, Sample};

/// The result of a check by the physics, in SI units if the recording is.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Plausibility {
    /// The line of the tangential contacts; none where less than a fifth of the scan in contact lies on one.
    pub line: Option<TangentialLine>,
    /// Shares of the scan in contact that a single contact explains, or not.
    pub shares: Shares,
    /// The conclusions; none where everything fits.
    pub findings: Vec<Finding>,
}

impl Plausibility {
    /// Whether recording, units and rod fit together: no finding is a misfit.
    pub fn fits(&self) -> bool {
        !self.findings.iter().any(Finding::is_misfit)
    }
}

/// Checks by the physics whether the samples can be of this rod. Samples that are not finite are left out.
///
/// No contact phase is needed, so that the check works where wrong units make all phases wrong. Nothing is corrected: friction bends
/// the line, too, unless it is given ([`plausibility_with_friction`]).
///
/// Accuracy: on noise-free scans the slope is EI to rounding. On the paper's nine scans, which were used during development, with noise
/// of 2.5 mN and 0.06 mN m (85,000 samples each), it is EI to 0.02 %. With a tenth of the samples it is too large by 0.3 %, because
/// some contacts of the tip cannot be distinguished from tangential ones; its standard error does not include this.
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
    plausibility_with_friction(rod, samples, |_| 0.0)
}

/// [`plausibility`] of a rod that slides over the object. `friction` is the coefficient of each sample by its number, as
/// [`Reconstruction::frictions`](crate::Reconstruction::frictions) has it: positive where friction draws the rod from its clamp towards its tip.
/// The line is that of m0z^2 over 2 (f0y sin phi0 + f0x cos phi0) + 2 |F| sin rho.
pub fn plausibility_with_friction(rod: &Rod, samples: &[Sample], friction: impl Fn(usize) -> f64) -> Plausibility {
    let bins = bins(samples, friction);
    if bins.is_empty() {
        return Plausibility { findings: vec![Finding::NoContact], ..Plausibility::default() };
    }
    let found = line_of(&bins);
    let shares = Shares::of(rod, &bins);
    let line = found.as_ref().map(|found| found.line);
    let findings = findings(rod, samples, &bins, found.as_ref(), shares);
    Plausibility { line, shares, findings }
}
