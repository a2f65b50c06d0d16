//! Reactions over the time of their sensor.

use super::frame::averages;
use vibrissa::rod::Reactions;
use vibrissa::{Pose, Sample};

/// Standard deviations beyond which a reaction has changed.
pub(super) const SIGMAS: f64 = 6.0;

/// Reactions with the times of the sensor.
pub(super) type Timed = (f64, Reactions);

/// When the reactions first differ from those at the start, and when they last differ from those at the end, s on the sensor's clock.
pub(super) fn changes(sensed: &[Timed]) -> Option<[f64; 2]> {
    let (averages, noise) = timed_averages(sensed)?;
    let differs = |a: &Sample, b: &Sample| {
        let (a, b) = (a.reactions, b.reactions);
        [a.f0x - b.f0x, a.f0y - b.f0y, a.m0z - b.m0z]
            .iter()
            .zip(noise)
            .any(|(difference, noise)| difference.abs() > SIGMAS * noise)
    };
    let (first, last) = (averages.first()?, averages.last()?);
    let start = averages.iter().position(|sample| differs(sample, first))?;
    let end = averages.iter().rposition(|sample| differs(sample, last))?;
    Some([averages[start].pose.x, averages[end].pose.x])
}

/// Averages whose x is the time, and their noise.
pub(super) fn timed_averages(sensed: &[Timed]) -> Option<(Vec<Sample>, [f64; 3])> {
    let timed = |(t, reactions): &Timed| Sample::new(Pose { x: *t, y: 0.0, phi: 0.0 }, *reactions);
    let samples: Vec<Sample> = sensed.iter().map(timed).collect();
    averages(&samples).map(|(averages, noise, _)| (averages, noise))
}
