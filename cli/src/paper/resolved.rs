//! A scan turned back into contact points with what the reactions tell of the contact phases.

use super::PaperError;
use super::scans::PaperScan;
use rod_files::naive_touch;
use vibrissa::contour::StretchKind;
use vibrissa::reconstruct::score::signed_distance;
use vibrissa::reconstruct::{Reason, Touch};
use vibrissa::{Composite, Sample, Settings, Sweep, reconstruct};

/// Clamp travel between samples, m: a tenth of the rate that the paper recorded at.
const STEP: f64 = 2e-5;

/// What was found where there are two contacts, m.
pub(crate) struct ResolvedScan<'a> {
    pub scan: &'a PaperScan,
    /// Points of single contacts.
    pub single: Vec<(f64, f64)>,
    /// First and second of two contacts.
    pub first: Vec<(f64, f64)>,
    pub second: Vec<(f64, f64)>,
    /// Where the same samples would have a single contact.
    pub naive: Vec<(f64, f64)>,
    /// Where the pieces of the contour meet in a notch.
    pub notches: Vec<(f64, f64)>,
    /// Largest distance from the true contour: of first and second contacts, and of the naive points.
    pub error: f64,
    pub naive_error: f64,
    /// Share of the samples with two contacts of which both are resolved.
    pub share: f64,
}

impl<'a> ResolvedScan<'a> {
    /// Records the scan without noise, and reconstructs it from its reactions alone.
    ///
    /// # Errors
    /// [`PaperError`].
    pub fn of(scan: &'a PaperScan) -> Result<Self, PaperError> {
        let scene = &scan.scan.scene;
        let states = Sweep::new(&scene.rod, &scene.objects, scene.path, STEP)?.run().states;
        let samples: Vec<Sample> = states.iter().map(|state| Sample::new(state.pose, state.reactions)).collect();
        let found = reconstruct(scene.rod.at_clamp(), &samples, &Settings::default())?;
        let mut resolved = Self {
            scan,
            single: Vec::new(),
            first: Vec::new(),
            second: Vec::new(),
            naive: Vec::new(),
            notches: scene.objects.iter().flat_map(notches).collect(),
            error: 0.0,
            naive_error: 0.0,
            share: 0.0,
        };
        let off = |touch: &Touch| signed_distance(&scene.objects, touch.x, touch.y).unwrap_or(0.0).abs();
        let (mut of, mut both) = (0, 0);
        for (reading, sample) in found.readings.iter().zip(&samples) {
            let place = |touch: &Touch| (touch.x, touch.y);
            let Some(pair) = reading.second else {
                resolved.single.extend(reading.touch.as_ref().ok().map(place));
                continue;
            };
            of += 1;
            both += usize::from(reading.touch.is_ok() && pair.is_ok());
            for (touch, places) in [(reading.touch, &mut resolved.first), (pair, &mut resolved.second)] {
                if let Ok::<Touch, Reason>(touch) = touch {
                    resolved.error = resolved.error.max(off(&touch));
                    places.push(place(&touch));
                }
            }
            if let Some(touch) = naive_touch(&scene.rod, sample) {
                resolved.naive_error = resolved.naive_error.max(off(&touch));
                resolved.naive.push(place(&touch));
            }
        }
        resolved.share = f64::from(both as u32) / f64::from(of.max(1) as u32);
        Ok(resolved)
    }
}

fn notches(object: &Composite) -> impl Iterator<Item = (f64, f64)> + '_ {
    let notch = |index: &usize| matches!(object.kind(*index), StretchKind::Notch { .. });
    (0..object.stretches().len()).filter(notch).map(|index| {
        let at = object.frame_on(index, object.stretch(index).range.from);
        (at.x, at.y)
    })
}
