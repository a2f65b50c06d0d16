//! The reconstruction of a recording whose clamp turns back.

use super::reading::{Reading, Reason};
use super::reconstruct::reconstruct;
use super::reconstruction::{Pass, Reconstruction};
use super::settings::{ReconstructError, Settings};
use crate::phase::{Label, PlaceNumber};
use crate::scan::{Fault, passes};
use rod_core::{Rod, Sample};
use std::ops::Range;

/// [`reconstruct`] for each of the [`passes`] of a recording, joined: samples are numbered through. A pass with too few samples has no
/// answers. Errors that samples share are found for each pass on its own.
///
/// # Errors
/// [`ReconstructError`]: that of the longest pass, if no pass can be reconstructed.
pub fn reconstruct_passes(
    rod: &Rod,
    samples: &[Sample],
    settings: &Settings,
) -> Result<Reconstruction, ReconstructError> {
    each_pass(rod, samples, |pass| reconstruct(rod, pass, settings))
}

/// The reconstructions of all passes, joined; `units` is a rod of the same units.
pub(super) fn each_pass(
    units: &Rod,
    samples: &[Sample],
    reconstruct: impl Fn(&[Sample]) -> Result<Reconstruction, ReconstructError>,
) -> Result<Reconstruction, ReconstructError> {
    let ranges = passes(units, samples);
    if ranges.len() < 2 {
        return reconstruct(samples);
    }
    let each = |pass: &Range<usize>| reconstruct(samples.get(pass.clone()).unwrap_or_default());
    let found: Vec<_> = ranges.iter().map(each).collect();
    let longest = (0..found.len()).max_by_key(|k| (found[*k].is_ok(), ranges[*k].len()));
    let (noise, steps) = match longest.map(|k| &found[k]) {
        Some(Ok(result)) => (result.noise, result.steps),
        Some(Err(error)) => return Err(error.clone()),
        None => return reconstruct(samples),
    };
    let mut whole = Reconstruction {
        readings: Vec::with_capacity(samples.len()),
        runs: Vec::new(),
        kinks: Vec::new(),
        noise,
        steps,
        passes: Vec::with_capacity(ranges.len()),
        evidence: Vec::new(),
        windows: Vec::new(),
    };
    for (pass, result) in ranges.into_iter().zip(found) {
        match result {
            Ok(part) => whole.join(pass, part),
            Err(_) => whole.join_nothing(pass),
        }
    }
    Ok(whole)
}

impl Reconstruction {
    /// Adds the next pass.
    fn join(&mut self, samples: Range<usize>, part: Self) {
        // samples and places are numbered within the pass
        let (first, places) = (samples.start, self.evidence.len());
        let place = |PlaceNumber(number): PlaceNumber| PlaceNumber(number.saturating_add(places));
        self.readings
            .extend(part.readings.into_iter().map(|reading| Reading { place: place(reading.place), ..reading }));
        self.runs.extend(part.runs.into_iter().map(|(start, label)| (start + first, label)));
        self.kinks.extend(part.kinks.into_iter().map(|mut kink| {
            kink.next += first;
            kink
        }));
        self.passes.extend(part.passes.into_iter().map(|pass| Pass { samples: samples.clone(), ..pass }));
        self.evidence.extend(part.evidence);
        self.windows.extend(part.windows);
    }

    /// Adds a pass without answers.
    fn join_nothing(&mut self, samples: Range<usize>) {
        let label = self.readings.last().map_or(Label::Free, |before| before.label);
        self.runs.push((samples.start, label));
        let without = Reading::without(label, Reason::Fault(Fault::TooFew));
        self.readings.extend(samples.clone().map(|_| without));
        self.passes.push(Pass { samples, calibration: None, used_friction: 0.0, friction: None });
    }
}
