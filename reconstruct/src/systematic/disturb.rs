//! Errors that all samples of a scan share, put on true samples.

use super::correction::motion;
use super::source::Source;
use crate::scan::Track;
use rod_core::{Reactions, Rod, RodError, Sample};
use std::f64::consts::PI;

/// What a laboratory with these errors records of true samples, and the rod as it is given there: the inverse of the correction of a
/// reconstruction.
///
/// `error` is the error of each source in its unit. The natural curvature is not put on: a rod with one has other shapes, which
/// reactions of a straight rod do not tell. The compliance of the clamp shows as recorded angles that follow the moment.
///
/// # Errors
/// A length or stiffness that is no rod's.
pub fn disturb(rod: &Rod, samples: &[Sample], error: impl Fn(Source) -> f64) -> Result<(Rod, Vec<Sample>), RodError> {
    let given = Rod::new(
        rod.length() / (1.0 + error(Source::Length)),
        rod.bending_stiffness() / (1.0 + error(Source::Stiffness)),
    )?;
    let mut disturbed = samples.to_vec();
    for sample in &mut disturbed {
        add_clamp_errors(rod, sample, &error);
    }
    add_stage_errors(rod, &mut disturbed, &error);
    // drift depends on the position in the scan as it is recorded
    let (track, indices) = Track::new(&given, &disturbed);
    let ends = (track.tau.first().copied().unwrap_or(0.0), track.tau.last().copied().unwrap_or(0.0));
    let mut part = 0.0;
    for (sample, index) in disturbed.iter_mut().zip(indices) {
        if let Ok(index) = index {
            part = (track.tau[index.0] - ends.0) / (ends.1 - ends.0).max(f64::MIN_POSITIVE);
        }
        add_channel_errors(&given, sample, part, &error);
    }
    Ok((given, disturbed))
}

/// The recorded angle of a clamp that yields, and the moment about a point beside it.
fn add_clamp_errors(rod: &Rod, sample: &mut Sample, error: &impl Fn(Source) -> f64) {
    let moment = sample.reactions.m0z / rod.units().moment;
    sample.pose.phi += error(Source::ClampCompliance) * moment;
    let (sin, cos) = sample.pose.phi.sin_cos();
    let Reactions { f0x, f0y, .. } = sample.reactions;
    let (along, across) = (error(Source::LeverAlong), error(Source::LeverAcross));
    sample.reactions.m0z -= along * (f0y * cos - f0x * sin) - across * (f0x * cos + f0y * sin);
    sample.pose.phi -= error(Source::ClampAngle);
}

/// The poses that a stage with a wrong scale records too late.
fn add_stage_errors(rod: &Rod, samples: &mut [Sample], error: &impl Fn(Source) -> f64) {
    let (track, indices) = Track::new(rod, samples);
    let Some(first) = samples.first().map(|sample| sample.pose) else { return };
    let (lag, scale) = (error(Source::Lag), 1.0 + error(Source::StageScale));
    let rate = |index: usize| motion(&track, index);
    let start = if track.len() > 1 { rate(0) * lag } else { Default::default() };
    let (x, y) = (first.x - start.x * scale, first.y - start.y * scale);
    let mut last = start;
    for (sample, index) in samples.iter_mut().zip(indices) {
        if let Ok(index) = index {
            last = rate(index.0) * lag;
        }
        sample.pose.x = x + (sample.pose.x - x) / scale - last.x;
        sample.pose.y = y + (sample.pose.y - y) / scale - last.y;
        sample.pose.phi -= last.z / rod.length();
    }
}

/// What the channels show.
fn add_channel_errors(given: &Rod, sample: &mut Sample, part: f64, error: &impl Fn(Source) -> f64) {
    let length = given.length();
    let Reactions { f0x, f0y, m0z } = sample.reactions;
    let shift = |bias, drift, bow| error(bias) + error(drift) * (part - 0.5) + error(bow) * (PI * part).sin();
    sample.reactions = Reactions {
        f0x: (1.0 + error(Source::GainF0x)) * f0x
            + error(Source::F0yInF0x) * f0y
            + error(Source::M0zInF0x) * m0z / length
            + shift(Source::BiasF0x, Source::DriftF0x, Source::BowF0x),
        f0y: error(Source::F0xInF0y) * f0x
            + (1.0 + error(Source::GainF0y)) * f0y
            + error(Source::M0zInF0y) * m0z / length
            + shift(Source::BiasF0y, Source::DriftF0y, Source::BowF0y),
        m0z: length * (error(Source::F0xInM0z) * f0x + error(Source::F0yInM0z) * f0y)
            + (1.0 + error(Source::GainM0z)) * m0z
            + shift(Source::BiasM0z, Source::DriftM0z, Source::BowM0z),
    };
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::systematic::Budget;
    use crate::systematic::correction::{Correction, Frame};
    use crate::systematic::source::{Errors, SOURCES};
    use rod_core::Pose;

    fn scan(turns: f64) -> Vec<Sample> {
        let sample = |k: u32| {
            let t = f64::from(k) / 200.0;
            let pose = Pose { x: 0.02 - 0.1 * t, y: 0.01 * t, phi: 1.5 + turns * t };
            let (f0x, f0y) = (0.2 * (3.0 * t).sin(), -0.1 + 0.3 * t * t);
            Sample::new(pose, Reactions { f0x, f0y, m0z: 0.02 * (2.0 * t).cos() })
        };
        (0..200).map(sample).collect()
    }

    fn errors(given: &Rod, error: impl Fn(Source) -> f64) -> Errors {
        Errors::from_fn(|k, _| error(Source::ALL[k]) / Source::ALL[k].unit(given))
    }

    #[test]
    fn the_correction_takes_the_errors_off_again() {
        let rod = Rod::new(0.1, 6.3e-4).unwrap();
        let budget = Budget::laboratory(&rod);
        // one after the other, and all together
        for only in (0..SOURCES).map(Some).chain([None]) {
            let error = |source: Source| {
                let number = source as usize;
                let takes_part = source != Source::NaturalCurvature && only.is_none_or(|only| only == number);
                let sign = if number.is_multiple_of(2) { 1.5 } else { -1.0 };
                if takes_part { sign * budget.of(source) } else { 0.0 }
            };
            let samples = scan(0.0);
            let (given, recorded) = disturb(&rod, &samples, error).unwrap();
            let (track, indices) = Track::new(&given, &recorded);
            assert!(indices.iter().all(Result::is_ok), "{only:?}");
            let correction = Correction::new(Frame::of(&track).unwrap(), &errors(&given, error)).unwrap();
            let corrected = correction.track(&track);
            let (truth, _) = Track::new(&rod, &samples);
            let off = |k: usize| {
                let (a, b) = (&corrected.clamps[k], &truth.clamps[k]);
                (a.pose - b.pose).amax().max((a.reactions - b.reactions).amax())
            };
            let worst = (0..samples.len()).map(off).fold(0.0, f64::max);
            // the recorded angle of a clamp that yields changes along the scan, and so does the direction of the lag
            let bound = if only.is_none() { 2e-5 } else { 1e-12 };
            assert!(worst < bound, "{only:?}: {worst}");
        }
    }

    #[test]
    fn no_error_changes_nothing() {
        let rod = Rod::new(0.1, 6.3e-4).unwrap();
        let samples = scan(0.4);
        assert_eq!(disturb(&rod, &samples, |_| 0.0).unwrap(), (rod, samples));
    }
}
