//! Samples that stick out.

use crate::quality::Quality;
use crate::reaction_sample::ReactionSample;
use core::array::from_fn;
use rod_core::{Reactions, Scalar};

/// Standard deviation of normal noise over the median of its deviations' sizes.
const NORMAL: f64 = 1.4826;

/// Spikes are no smaller than this share of the largest value in the window: that is rounding, of single precision, too.
const ROUNDING: f64 = 1e-6;

/// Half a window that is straight to this share of the limit is no spike, whatever the other half does.
const STRAIGHT: f64 = 0.25;

/// Marks spikes with [`Quality::SPIKE`], by a window of `N` samples, after Hampel: a channel's value farther from the median of
/// the window than `k` times the noise. The noise is the one given, or that of the window by its median deviation where that
/// is larger. No value is changed and no sample left out.
///
/// A spike returns within `N / 2` samples. What does not is no spike: snaps, however high, and kinks stay as they are. The
/// first and last `N / 2` samples of all are not judged.
///
/// Samples come out `N / 2` samples late.
///
/// ```
/// use rod_core::Reactions;
/// use rod_hw::{Despike, Frame, Mounting, Quality, Wrench, WrenchSample};
/// let mounting = Mounting::new(Frame::same());
/// let pose = rod_core::Pose { x: 0.0, y: 0.0, phi: 1.5 };
/// // a snap at 20, a spike at 30
/// let moment = |i: u32| 1e-5 * f64::from(i) + if i >= 20 { 0.03 } else { 0.0 } + if i == 30 { 1e-3 } else { 0.0 };
/// let samples = (0..50_u32).map(|i| {
///     let torque = [0.0, 0.0, moment(i)];
///     mounting.reactions(&WrenchSample::new(2e-3 * f64::from(i), Wrench { force: [0.0; 3], torque }), pose)
/// });
/// let mut despike = Despike::<7>::new(5.0, Reactions { f0x: 2e-3, f0y: 2e-3, m0z: 5e-5 })?;
/// let mut found: Vec<_> = samples.filter_map(|sample| despike.push(sample)).collect();
/// found.extend(std::iter::from_fn(|| despike.finish()));
/// assert_eq!(found.len(), 50);
/// let spikes: Vec<usize> = (0..50).filter(|&i| found[i].quality.contains(Quality::SPIKE)).collect();
/// assert_eq!(spikes, [30]);
/// # Ok::<(), rod_hw::DespikeError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Despike<const N: usize = 7, T = f64> {
    k: f64,
    noise: [f64; 3],
    /// A ring, with the place of the next sample.
    window: [Option<ReactionSample<T>>; N],
    next: usize,
    /// Samples in the window that are still to be handed on.
    waiting: usize,
}

/// Why spikes cannot be told.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DespikeError {
    /// So few standard deviations are noise.
    #[error("spikes beyond {k} standard deviations, expected 3 or more; 5 leaves nearly all noise alone")]
    Threshold {
        /// How many.
        k: f64,
    },
    /// A noise that is none.
    #[error("the noise of {channel} is {value}, expected a finite number, 0 or more")]
    Noise {
        /// Of which channel.
        channel: &'static str,
        /// Its value.
        value: f64,
    },
}

impl<const N: usize, T: Scalar> Despike<N, T> {
    /// How many samples late a sample comes out.
    pub const DELAY: usize = N / 2;

    /// Spikes beyond `k` (3 or more; 5 is usual) standard deviations, with the noise known of the channels (N, N, N m): where
    /// a sensor counts in steps, a step at least. `N` is odd, 3 or more.
    ///
    /// # Errors
    /// [`DespikeError`].
    pub fn new(k: f64, noise: Reactions<T>) -> Result<Self, DespikeError> {
        const { assert!(N >= 3 && N % 2 == 1, "an odd number of samples, 3 or more") };
        if k.is_nan() || k < 3.0 {
            return Err(DespikeError::Threshold { k });
        }
        let noise = [noise.f0x, noise.f0y, noise.m0z].map(T::to_f64);
        for (channel, value) in ["f0x", "f0y", "m0z"].into_iter().zip(noise) {
            if !value.is_finite() || value < 0.0 {
                return Err(DespikeError::Noise { channel, value });
            }
        }
        Ok(Self { k, noise, window: [None; N], next: 0, waiting: 0 })
    }

    /// Takes a sample, and returns the one [`DELAY`](Self::DELAY) samples before.
    pub fn push(&mut self, sample: ReactionSample<T>) -> Option<ReactionSample<T>> {
        self.window[self.next] = Some(sample);
        self.next = (self.next + 1) % N;
        self.waiting += 1;
        if self.waiting <= Self::DELAY { None } else { self.hand_on() }
    }

    /// One of the samples that are left when no more come; none when there are none left. After that it is as new.
    pub fn finish(&mut self) -> Option<ReactionSample<T>> {
        if self.waiting == 0 {
            self.window = [None; N];
            return None;
        }
        self.hand_on()
    }

    /// The first of those waiting, judged where it is in the middle of a full window.
    fn hand_on(&mut self) -> Option<ReactionSample<T>> {
        let age = self.waiting;
        self.waiting -= 1;
        let mut sample = self.window[(self.next + N - age) % N]?;
        if age == Self::DELAY + 1 && self.sticks_out() {
            sample.quality |= Quality::SPIKE;
        }
        Some(sample)
    }

    /// Whether the sample in the middle does, in any channel; not where the window is not full.
    fn sticks_out(&self) -> bool {
        let mut channels = [[0.0; N]; 3];
        for i in 0..N {
            let Some(sample) = &self.window[(self.next + i) % N] else { return false };
            let Reactions { f0x, f0y, m0z } = sample.reactions;
            for (channel, value) in channels.iter_mut().zip([f0x, f0y, m0z]) {
                channel[i] = value.to_f64();
            }
        }
        channels.iter().zip(self.noise).any(|(values, noise)| is_spike(values, self.k, noise))
    }
}

/// Whether the value in the middle is one.
fn is_spike<const N: usize>(values: &[f64; N], k: f64, noise: f64) -> bool {
    let i = N / 2;
    let value = values[i];
    let middle = median(*values);
    let scatter = NORMAL * median::<N>(from_fn(|i| (values[i] - middle).abs()));
    let largest = values.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
    let limit = k * noise.max(scatter) + ROUNDING * largest;
    let straight = |at: &dyn Fn(usize) -> f64| {
        let slope = (at(i) - value) / i as f64;
        (1..i).all(|j| (at(j) - value - slope * j as f64).abs() <= STRAIGHT * limit)
    };
    let part = N > 3 && (straight(&|j| values[i - j]) || straight(&|j| values[i + j]));
    (value - middle).abs() > limit && !part
}

fn median<const N: usize>(mut values: [f64; N]) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    values[N / 2]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Frame, Mounting, Wrench, WrenchSample};
    use proptest::prelude::*;
    use rod_core::Pose;

    const NOISE: Reactions = Reactions { f0x: 2e-3, f0y: 2e-3, m0z: 1e-3 };

    fn samples(moments: &[f64]) -> Vec<ReactionSample> {
        let mounting = Mounting::new(Frame::same());
        let sample = |(i, m): (u32, &f64)| {
            let wrench = Wrench { force: [0.0; 3], torque: [0.0, 0.0, *m] };
            mounting.reactions(&WrenchSample::new(f64::from(i), wrench), Pose { x: 0.0, y: 0.0, phi: 0.0 })
        };
        (0..).zip(moments).map(sample).collect()
    }

    fn spikes<const N: usize>(noise: Reactions, moments: &[f64]) -> Vec<usize> {
        let mut despike = Despike::<N>::new(5.0, noise).unwrap();
        let samples = samples(moments);
        let mut found: Vec<_> = samples.iter().filter_map(|sample| despike.push(*sample)).collect();
        assert_eq!(found.len(), samples.len().saturating_sub(Despike::<N>::DELAY));
        found.extend(core::iter::from_fn(|| despike.finish()));
        for (before, after) in samples.iter().zip(&found) {
            assert_eq!(ReactionSample { quality: before.quality, ..*after }, *before);
        }
        assert_eq!(found.len(), samples.len());
        (0..found.len()).filter(|&i| found[i].quality.contains(Quality::SPIKE)).collect()
    }

    fn noisy(bound: f64) -> impl Strategy<Value = Vec<f64>> {
        proptest::collection::vec(-bound..=bound, 60)
    }

    proptest! {
        #[test]
        fn a_step_of_any_size_is_none(noise in noisy(2e-3), at in 0_usize..60, power in -6.0_f64..3.0, up: bool) {
            let size = if up { 1.0 } else { -1.0 } * 10_f64.powf(power);
            let step: Vec<f64> = (0..).zip(&noise).map(|(i, e)| e + if i >= at { size } else { 0.0 }).collect();
            prop_assert_eq!(spikes::<7>(NOISE, &step), []);
            prop_assert_eq!(spikes::<5>(NOISE, &step), []);
            let clean: Vec<f64> = (0..60).map(|i| if i >= at { size } else { 0.0 }).collect();
            prop_assert_eq!(spikes::<7>(Reactions::default(), &clean), []);
        }

        #[test]
        fn slopes_kinks_and_steps_between_slopes_are_none(
            at in 0_u8..60, slopes in [-1.0_f64..1.0, -1.0_f64..1.0], step in prop_oneof![Just(0.0), -5.0..5.0], offset in -9.0..9.0,
        ) {
            let value = |i: u8| {
                let from = f64::from(i) - f64::from(at);
                offset + if i < at { slopes[0] * from } else { step + slopes[1] * from }
            };
            let moments: Vec<f64> = (0..60).map(value).collect();
            for noise in [Reactions::default(), NOISE] {
                prop_assert_eq!(spikes::<7>(noise, &moments), []);
                prop_assert_eq!(spikes::<11>(noise, &moments), []);
            }
        }

        #[test]
        fn one_that_sticks_out_is_marked_alone(
            noise in noisy(1e-3), at in 3_usize..57, beyond in 25e-3_f64..1.0, up: bool, slope in -1e-3..1e-3,
        ) {
            let mut moments: Vec<f64> = (0_u8..).zip(&noise).map(|(i, e)| slope * f64::from(i) + e).collect();
            moments[at] += if up { beyond } else { -beyond };
            prop_assert_eq!(spikes::<7>(NOISE, &moments), [at]);
        }
    }

    proptest! {
        /// Beyond k standard deviations by as much as the samples themselves scatter.
        #[test]
        fn a_small_one_in_a_quiet_signal_too(
            noise in noisy(0.3e-3), at in 3_usize..57, beyond in 6e-3_f64..9e-3, up: bool,
        ) {
            let mut moments = noise;
            moments[at] += if up { beyond } else { -beyond };
            prop_assert_eq!(spikes::<7>(NOISE, &moments), [at]);
            prop_assert_eq!(spikes::<5>(NOISE, &moments), [at]);
        }
    }

    #[test]
    fn up_to_half_a_window_is_a_spike_and_more_is_none() {
        let pulse =
            |length| (0..40).map(|i| if (20..20 + length).contains(&i) { 1.0 } else { 0.0 }).collect::<Vec<f64>>();
        assert_eq!(spikes::<7>(NOISE, &pulse(3)), [20, 21, 22]);
        assert_eq!(spikes::<7>(NOISE, &pulse(4)), []);
        assert_eq!(spikes::<3>(NOISE, &pulse(1)), [20]);
    }

    #[test]
    fn few_samples_come_out_unjudged() {
        for count in 0..7 {
            let mut moments = vec![0.0; count];
            if let Some(last) = moments.last_mut() {
                *last = 1.0;
            }
            assert_eq!(spikes::<7>(NOISE, &moments), []);
        }
    }

    #[test]
    fn single_precision() {
        let mounting = Mounting::<f32>::new(Frame::same());
        let mut despike = Despike::<5, f32>::new(5.0, Reactions { f0x: 1e-3, f0y: 1e-3, m0z: 1e-3 }).unwrap();
        let marked = (0..20_u8).filter_map(|i| {
            let wrench = Wrench { force: [if i == 9 { 0.1_f32 } else { 0.0 }, 0.0, 0.0], torque: [0.0; 3] };
            let pose = Pose { x: 0.0, y: 0.0, phi: 0.0 };
            despike.push(mounting.reactions(&WrenchSample::new(f64::from(i), wrench), pose))
        });
        assert_eq!(
            marked.filter(|sample| sample.quality.contains(Quality::SPIKE)).map(|s| s.t).collect::<Vec<_>>(),
            [9.0]
        );
    }

    #[test]
    fn refuses() {
        for k in [2.9, f64::NAN] {
            assert!(matches!(Despike::<7>::new(k, NOISE), Err(DespikeError::Threshold { .. })));
        }
        let error = Despike::<7>::new(5.0, Reactions { m0z: -1.0, ..NOISE }).unwrap_err().to_string();
        assert_eq!(error, "the noise of m0z is -1, expected a finite number, 0 or more");
    }
}
