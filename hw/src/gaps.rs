//! Samples that are missing.

use crate::quality::Quality;
use crate::raw::RawSample;
use crate::reaction_sample::{OutOfPlane, ReactionSample};
use rod_core::{Pose, Reactions};

/// The samples of a recording taken every `period` (s), with gaps of up to `most` samples filled on straight lines and the new
/// ones marked with [`Quality::INTERPOLATED`]. Longer gaps stay, and so do those after which the device started anew, those
/// beside a sample that is not usable, and all of them where the period is not a positive number.
///
/// ```
/// use rod_hw::{Frame, Mounting, Quality, Wrench, WrenchSample, fill_gaps};
/// let mounting = Mounting::new(Frame::same());
/// let sample = |i: f64| {
///     let wrench = Wrench { force: [-1e-3 * i, 0.0, 0.0], torque: [0.0; 3] };
///     mounting.reactions(&WrenchSample::new(2e-3 * i, wrench), rod_core::Pose { x: i, y: 0.0, phi: 0.0 })
/// };
/// let filled = fill_gaps(&[0.0, 1.0, 4.0, 5.0, 10.0].map(sample), 2e-3, 3);
/// let places: Vec<f64> = filled.iter().map(|sample| sample.pose.x.round()).collect();
/// assert_eq!(places, [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 10.0]);
/// assert_eq!(filled[2].quality, Quality::INTERPOLATED);
/// assert!((filled[2].reactions.f0x - 2e-3).abs() < 1e-15);
/// ```
pub fn fill_gaps(samples: &[ReactionSample], period: f64, most: usize) -> Vec<ReactionSample> {
    let mut filled: Vec<ReactionSample> = Vec::with_capacity(samples.len());
    for sample in samples {
        if let Some(before) = filled.last().copied() {
            let missing = ((sample.t - before.t) / period).round() - 1.0;
            let apart = sample.quality.contains(Quality::RESTARTED);
            let good = before.quality.is_usable() && sample.quality.is_usable() && !apart && period > 0.0;
            if good && missing >= 1.0 && missing <= most as f64 {
                let count = missing as usize;
                filled.extend((1..=count).map(|i| between(&before, sample, i as f64 / (count + 1) as f64)));
            }
        }
        filled.push(*sample);
    }
    filled
}

/// On the straight line from the one to the other.
fn between(from: &ReactionSample, to: &ReactionSample, share: f64) -> ReactionSample {
    let mix = |from: f64, to: f64| from + share * (to - from);
    let reactions = |from: Reactions, to: Reactions| Reactions {
        f0x: mix(from.f0x, to.f0x),
        f0y: mix(from.f0y, to.f0y),
        m0z: mix(from.m0z, to.m0z),
    };
    let both = |from: Option<Reactions>, to: Option<Reactions>| from.zip(to).map(|(from, to)| reactions(from, to));
    // what happened between samples did not happen to this one
    let quality = (from.quality | to.quality) - (Quality::GAP_BEFORE | Quality::RESTARTED);
    ReactionSample {
        t: mix(from.t, to.t),
        pose: Pose {
            x: mix(from.pose.x, to.pose.x),
            y: mix(from.pose.y, to.pose.y),
            phi: mix(from.pose.phi, to.pose.phi),
        },
        reactions: reactions(from.reactions, to.reactions),
        sigma: both(from.sigma, to.sigma),
        systematic: both(from.systematic, to.systematic),
        out_of_plane: OutOfPlane {
            f0z: mix(from.out_of_plane.f0z, to.out_of_plane.f0z),
            m0x: mix(from.out_of_plane.m0x, to.out_of_plane.m0x),
            m0y: mix(from.out_of_plane.m0y, to.out_of_plane.m0y),
        },
        quality: quality | Quality::INTERPOLATED,
        raw: RawSample { host_time: mix(from.raw.host_time, to.raw.host_time), ..RawSample::default() },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn sample(number: u32, quality: Quality) -> ReactionSample {
        let n = f64::from(number);
        ReactionSample {
            t: 1e-3 * n,
            pose: Pose { x: n, y: -n, phi: 0.1 * n },
            reactions: Reactions { f0x: 2.0 * n, f0y: 3.0 * n, m0z: -n },
            sigma: Some(Reactions { f0x: 1.0, f0y: 1.0, m0z: 1.0 }),
            systematic: None,
            out_of_plane: OutOfPlane { f0z: n, m0x: n, m0y: n },
            quality,
            raw: RawSample { host_time: n, ..RawSample::default() },
        }
    }

    proptest! {
        /// Of a straight line with holes, all samples come back but those of the long holes.
        #[test]
        fn fills_short_gaps_only(kept in proptest::collection::btree_set(0_u32..200, 2..150), most in 0_usize..6) {
            let samples: Vec<_> = kept.iter().map(|&n| sample(n, Quality::empty())).collect();
            let filled = fill_gaps(&samples, 1e-3, most);
            let found: Vec<u32> = filled.iter().map(|sample| sample.pose.x.round() as u32).collect();
            let numbers: Vec<u32> = kept.iter().copied().collect();
            let mut expected = vec![numbers[0]];
            for pair in numbers.windows(2) {
                if (pair[1] - pair[0]) as usize <= most + 1 {
                    expected.extend(pair[0] + 1..pair[1]);
                }
                expected.push(pair[1]);
            }
            prop_assert_eq!(&found, &expected);
            for (found, number) in filled.iter().zip(expected) {
                let exact = sample(number, Quality::empty());
                let made = !kept.contains(&number);
                prop_assert_eq!(found.quality.contains(Quality::INTERPOLATED), made);
                prop_assert!((found.reactions.f0y - exact.reactions.f0y).abs() < 1e-10);
                prop_assert!((found.t - exact.t).abs() < 1e-13 && found.sigma == exact.sigma);
            }
        }
    }

    #[test]
    fn leaves_what_is_no_gap_of_a_good_signal() {
        for quality in [Quality::RESTARTED, Quality::SATURATED, Quality::SPIKE] {
            let samples = [sample(0, Quality::empty()), sample(3, quality)];
            assert_eq!(fill_gaps(&samples, 1e-3, 10), samples);
        }
        let samples = [sample(0, Quality::empty()), sample(3, Quality::GAP_BEFORE | Quality::DEVICE_WARNING)];
        assert_eq!(fill_gaps(&samples, 1e-3, 10)[1].quality, Quality::INTERPOLATED | Quality::DEVICE_WARNING);
        for period in [0.0, -1.0, f64::NAN] {
            assert_eq!(fill_gaps(&samples, period, 10), samples);
        }
    }
}
