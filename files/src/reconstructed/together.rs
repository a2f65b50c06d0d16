//! One contour for several recordings.

use super::result::Reconstructed;
use serde::Serialize;
use vibrissa::reconstruct::{ContourFit, Reconstruction, fit_contours};
use vibrissa::{Sample, Settings};

/// How well one contour explains several recordings of one object.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Together {
    /// How many recordings were fitted.
    pub recordings: usize,
    /// Whether it explains all of them.
    pub explains: bool,
    /// Sum of the squares of the residuals, over their standard deviations.
    pub chi_squared: f64,
    /// Number of residuals less the unknowns that the recordings determine.
    pub degrees_of_freedom: f64,
    /// Whether each recording has a contour of its own that explains it.
    #[serde(skip)]
    pub each: bool,
}

impl Together {
    /// Fits a contour to each of several recordings of one object with one rod, and then one to all that have a fit and fit their rod; none where these are
    /// fewer than two, or where there is no fit. If one contour explains all, their labels, points and errors are its own from now on. Bias and drift
    /// are those of each recording; the errors of rod, sensor, clamp and stage are those of all. `settings` are those of the reconstructions. What is being
    /// fitted is told to `progress`.
    pub fn fit(found: &mut [Reconstructed], settings: &Settings, mut progress: impl FnMut(String)) -> Option<Self> {
        let mut locals = Vec::with_capacity(found.len());
        for one in found.iter_mut() {
            progress(format!("{}: fitting one contour to the whole recording", one.recording.file.display()));
            locals.push((one.found.clone(), one.check.clone()));
            one.fit(settings);
        }
        let fitted: Vec<usize> =
            (0..found.len()).filter(|k| found[*k].fits() && found[*k].fitted().is_some()).collect();
        let [first, _, ..] = fitted[..] else { return None };
        let has_own = |one: &Reconstructed| !one.fits() || one.fitted().is_none_or(|fit| fit.goodness.explains);
        let each = found.iter().all(has_own);
        progress(format!("fitting one contour to {} recordings", fitted.len()));
        let recordings: Vec<(&[Sample], &Reconstruction)> =
            fitted.iter().map(|k| (&found[*k].samples[..], &found[*k].found)).collect();
        let fits = match found[first].rod.uniform() {
            Some(rod) => fit_contours(rod, &recordings),
            None => fit_contours(&found[first].rod, &recordings),
        };
        let fits: Vec<ContourFit> = fits.ok()?;
        let sum = |of: fn(&ContourFit) -> f64| fits.iter().map(of).sum();
        let together = Self {
            recordings: fits.len(),
            explains: fits.iter().all(|fit| fit.goodness.explains),
            chi_squared: sum(|fit| fit.goodness.chi_squared),
            degrees_of_freedom: sum(|fit| fit.goodness.degrees_of_freedom),
            each,
        };
        if together.explains {
            let mut fits = fits.into_iter();
            for (k, local) in locals.into_iter().enumerate().filter(|(k, _)| fitted.contains(k)) {
                // in place of the fit of its own
                (found[k].found, found[k].check) = local;
                fits.next().into_iter().for_each(|fit| found[k].take(Ok(fit), settings));
            }
        }
        Some(together)
    }

    /// Why no contour explains the recordings; none where one does, or where not each recording has one of its own.
    pub fn contradiction(&self) -> Option<String> {
        (!self.explains && self.each).then(|| {
            format!(
                "each recording has a contour that explains it, but no contour was found that explains all {}: the object or the frame moved between \
                 them, or rod, sensor, clamp or stage changed; their contours are merged as they are",
                self.recordings
            )
        })
    }
}
