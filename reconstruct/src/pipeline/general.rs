//! The reconstruction of a scan of any rod on any clamp.

use super::each_pass::each_pass;
use super::reconstruct::reconstruct_by;
use super::reconstruction::Reconstruction;
use super::settings::{ReconstructError, Settings};
use crate::point::Any;
use rod_core::{PhysicalRod, Rod, Sample};

/// [`reconstruct_passes`](crate::reconstruct_passes) for any rod on any clamp: tapered, of sections, bent at rest, on springs. The poses
/// are those of the support. A uniform rod that is straight at rest has more answers there.
///
/// Kinks, rates and the phase diagram are as for the uniform rod. Of the criteria the arc length and the tangent are, too; the angle
/// between rod and contour where the moment vanishes takes the place of K ([`one_sample`](crate::one_sample)). It tells BA from BB where
/// stiffness and natural curvature are the same all along the rod. Otherwise each part between kinks is resolved as BA and as BB, and the
/// contacts that explain the reactions tell which it is. A part that neither explains has the label that the phases before and after
/// suggest, and no contact points ([`Unresolved`](crate::Unresolved)): so it is where BB turns into BA and noise hides that kink.
///
/// Errors that all samples share are estimated, taken off, and part of the covariances as for the uniform rod, but for one of its natural
/// curvature, which [`fit_contour`](crate::fit_contour) alone estimates. An error of the length stretches the rod as a whole, and one of the stiffness is the same all along it.
///
/// Accuracy: on noise-free samples single contact points are exact to 1e-9 of the rod's length, and so is the first of two contacts to 1e-8. The
/// second one is within 1e-8 of the contour; along it, 1e-6. In noise, each has its covariance.
///
/// ```no_run
/// use rod_core::{Rod, Sample};
/// use rod_reconstruct::{Settings, reconstruct_general};
/// # let samples: Vec<Sample> = Vec::new();
/// let whisker = Rod::tapered(0.04, 1e-4, 2e-5, 3e9)?.with_natural_curvature(10.0)?;
/// let found = reconstruct_general(&whisker, &samples, &Settings::default())?;
/// let points = found.readings.iter().filter_map(|reading| reading.touch.ok());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`ReconstructError`].
pub fn reconstruct_general<R: PhysicalRod>(
    rod: &R,
    samples: &[Sample],
    settings: &Settings,
) -> Result<Reconstruction, ReconstructError> {
    let units = rod.units();
    let stiffness = units.force * units.length * units.length;
    let what = "stiffness of the rod at its clamp";
    let uniform =
        Rod::new(units.length, stiffness).map_err(|_| ReconstructError::Setting { what, value: stiffness })?;
    let inverse = Any(rod);
    each_pass(&uniform, samples, |pass| reconstruct_by(&inverse, &uniform, pass, settings))
}
