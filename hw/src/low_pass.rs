//! A low-pass for recordings.

use crate::reaction_sample::ReactionSample;
use std::f64::consts::PI;

/// Samples may lie so far from even spacing, in periods.
const UNEVEN: f64 = 0.5;

/// A Butterworth low-pass that runs forward and backward over a recording: nothing is delayed, and the gain is that of the
/// filter squared, -6 dB at the cutoff.
///
/// It runs between breaks only: a low-pass across a kink or a snap would smear it over about speed / (2 cutoff) of the way. The
/// ends of each piece are continued by turning it over (odd padding), over three times the filter's length, or the piece's.
/// There it is least to be trusted. No filter is the usual choice: the inversion weighs noise by itself.
///
/// Coefficients are computed from tan(pi cutoff / rate), which keeps its digits at low cutoffs.
///
/// ```
/// use rod_hw::LowPass;
/// // 10 Hz at 500 Hz
/// let filter = LowPass::new(2, 10.0, 500.0)?;
/// let step: Vec<f64> = (0..200).map(|i| if i < 100 { 0.0 } else { 1.0 }).collect();
/// // with the step as a break it stays, without it is smeared
/// let kept = filter.apply(&step, &[100])?;
/// assert!(kept.iter().zip(&step).all(|(a, b)| (a - b).abs() < 1e-12));
/// let smeared = filter.apply(&step, &[])?;
/// assert!((smeared[99] - 0.48).abs() < 0.01 && smeared[90] > 0.05);
/// // a live filter of this kind would be late by sqrt(2) / (2 pi 10 Hz)
/// assert!((filter.causal_delay() - 0.0225).abs() < 1e-4);
/// # Ok::<(), rod_hw::LowPassError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct LowPass {
    sections: Vec<Section>,
    rate: f64,
    delay: f64,
}

/// Why something is not filtered.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LowPassError {
    /// An order that there is not.
    #[error("a filter of order {order}, expected 2, 4, 6 or 8")]
    Order {
        /// Its order.
        order: usize,
    },
    /// A cutoff that the samples cannot show.
    #[error("a cutoff of {cutoff} Hz at {rate} samples/s, expected it above 0 and below half of the rate")]
    Cutoff {
        /// Cutoff, Hz.
        cutoff: f64,
        /// Samples per second.
        rate: f64,
    },
    /// A value that is none.
    #[error("value {at} is {value}, expected a finite number")]
    NotFinite {
        /// Which one, from 0.
        at: usize,
        /// Its value.
        value: f64,
    },
    /// Breaks that do not lie in between, or not in order.
    #[error("a break before sample {at} of {count}, expected growing places between 1 and {}", .count.saturating_sub(1))]
    Break {
        /// Where it is.
        at: usize,
        /// How many samples there are.
        count: usize,
    },
    /// Samples that are not evenly spaced.
    #[error(
        "sample {at} comes {step} s after the one before, expected about {period} s; fill the gap first, or let it be a break"
    )]
    Uneven {
        /// Which one, from 0.
        at: usize,
        /// Time since the one before, s.
        step: f64,
        /// Time expected, s.
        period: f64,
    },
}

/// y_n = b0 x_n + b1 x_(n-1) + b2 x_(n-2) - a1 y_(n-1) - a2 y_(n-2)
#[derive(Clone, Copy, Debug, PartialEq)]
struct Section {
    b: [f64; 3],
    a: [f64; 2],
}

impl LowPass {
    /// Of an even order up to 8, with its -3 dB point in one direction at `cutoff` (Hz), for `rate` samples per second.
    ///
    /// # Errors
    /// [`LowPassError::Order`], [`LowPassError::Cutoff`].
    pub fn new(order: usize, cutoff: f64, rate: f64) -> Result<Self, LowPassError> {
        if ![2, 4, 6, 8].contains(&order) {
            return Err(LowPassError::Order { order });
        }
        if !(cutoff > 0.0 && cutoff < 0.5 * rate && rate.is_finite()) {
            return Err(LowPassError::Cutoff { cutoff, rate });
        }
        // the analogue frequency, in 2 rate, that the bilinear transform takes to the cutoff
        let k = (PI * cutoff / rate).tan();
        // twice the damping of each pair of poles on the circle
        let dampings = (0..order / 2).map(|i| 2.0 * (PI * (2 * i + 1) as f64 / (2 * order) as f64).sin());
        let sections = dampings.clone().map(|damping| Section::new(k, damping)).collect();
        let delay = dampings.map(|damping| damping / (2.0 * rate * k)).sum();
        Ok(Self { sections, rate, delay })
    }

    /// How late a slow signal would leave this filter if it ran forward only, as a live one must, s: the clamp is by then
    /// that far along its way.
    pub fn causal_delay(&self) -> f64 {
        self.delay
    }

    /// The values filtered between breaks; a break is the place of the first value of a piece.
    ///
    /// # Errors
    /// [`LowPassError::NotFinite`], [`LowPassError::Break`].
    pub fn apply(&self, values: &[f64], breaks: &[usize]) -> Result<Vec<f64>, LowPassError> {
        if let Some((at, &value)) = values.iter().enumerate().find(|(_, value)| !value.is_finite()) {
            return Err(LowPassError::NotFinite { at, value });
        }
        let mut filtered = Vec::with_capacity(values.len());
        for piece in pieces(values.len(), breaks)? {
            filtered.extend(self.piece(&values[piece]));
        }
        Ok(filtered)
    }

    /// Filters the reactions of samples taken evenly at the filter's rate; gaps must be breaks, or be filled before. Spikes
    /// and saturated samples spread over their neighbours: leave them out and fill the gap. Standard deviations stay those
    /// of the samples as they were.
    ///
    /// # Errors
    /// [`LowPassError`]; the samples are then as before.
    pub fn apply_to_reactions(&self, samples: &mut [ReactionSample], breaks: &[usize]) -> Result<(), LowPassError> {
        let period = 1.0 / self.rate;
        for (at, pair) in (1..).zip(samples.windows(2)) {
            let step = pair[1].t - pair[0].t;
            let even = (step - period).abs() <= UNEVEN * period;
            if !even && !breaks.contains(&at) {
                return Err(LowPassError::Uneven { at, step, period });
            }
        }
        let channel = |of: fn(&ReactionSample) -> f64| self.apply(&samples.iter().map(of).collect::<Vec<_>>(), breaks);
        let f0x = channel(|sample| sample.reactions.f0x)?;
        let f0y = channel(|sample| sample.reactions.f0y)?;
        let m0z = channel(|sample| sample.reactions.m0z)?;
        for (sample, ((f0x, f0y), m0z)) in samples.iter_mut().zip(f0x.into_iter().zip(f0y).zip(m0z)) {
            sample.reactions = rod_core::Reactions { f0x, f0y, m0z };
        }
        Ok(())
    }

    /// One piece without breaks.
    fn piece(&self, values: &[f64]) -> Vec<f64> {
        let (Some(first), Some(last)) = (values.first(), values.last()) else { return Vec::new() };
        let padding = (3 * (2 * self.sections.len() + 1)).min(values.len() - 1);
        let before = values[1..=padding].iter().rev().map(|value| 2.0 * first - value);
        let after = values[values.len() - 1 - padding..values.len() - 1].iter().rev().map(|value| 2.0 * last - value);
        let mut padded: Vec<f64> = before.chain(values.iter().copied()).chain(after).collect();
        for _ in 0..2 {
            for section in &self.sections {
                section.run(&mut padded);
            }
            padded.reverse();
        }
        padded.drain(padding..padding + values.len()).collect()
    }
}

impl Section {
    /// k^2 / (s^2 + damping k s + k^2) by the bilinear transform.
    fn new(k: f64, damping: f64) -> Self {
        let scale = 1.0 / (1.0 + damping * k + k * k);
        let b = k * k * scale;
        Self { b: [b, 2.0 * b, b], a: [2.0 * (k * k - 1.0) * scale, (1.0 - damping * k + k * k) * scale] }
    }

    /// Filters in place, as if the first value had been there for ever.
    fn run(&self, values: &mut [f64]) {
        let Self { b, a } = *self;
        let first = values.first().copied().unwrap_or(0.0);
        let mut state = [(1.0 - b[0]) * first, (b[2] - a[1]) * first];
        for value in values {
            let x = *value;
            let y = b[0] * x + state[0];
            state = [b[1] * x - a[0] * y + state[1], b[2] * x - a[1] * y];
            *value = y;
        }
    }
}

/// From break to break.
fn pieces(count: usize, breaks: &[usize]) -> Result<Vec<std::ops::Range<usize>>, LowPassError> {
    let mut pieces = Vec::with_capacity(breaks.len() + 1);
    let mut from = 0;
    for &at in breaks {
        if at <= from || at >= count {
            return Err(LowPassError::Break { at, count });
        }
        pieces.push(from..at);
        from = at;
    }
    pieces.push(from..count);
    Ok(pieces)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Constants stay; straight lines do far from their ends: there is no delay.
        #[test]
        fn straight_lines_stay(
            order in 1_usize..=4, ratio in 0.05..0.45, count in 1_usize..100, offset in -1.0_f64..1.0, slope in -1.0_f64..1.0,
        ) {
            let filter = LowPass::new(2 * order, 100.0 * ratio, 100.0).unwrap();
            let flat = filter.apply(&vec![offset; count], &[]).unwrap();
            prop_assert!(flat.iter().all(|value| (value - offset).abs() < 1e-10));
            let line: Vec<f64> = (0..1001).map(|i| offset + slope * f64::from(i)).collect();
            let filtered = filter.apply(&line, &[]).unwrap();
            prop_assert!((filtered[500] - line[500]).abs() < 1e-8, "{} {}", filtered[500], line[500]);
        }

        /// Nothing crosses a break.
        #[test]
        fn pieces_are_filtered_alone(
            values in proptest::collection::vec(-1.0..1.0, 3..120), share in 0.0..1.0, order in 1_usize..=4,
        ) {
            let filter = LowPass::new(2 * order, 7.0, 100.0).unwrap();
            let at = 1 + ((values.len() - 2) as f64 * share) as usize;
            let both = filter.apply(&values, &[at]).unwrap();
            prop_assert_eq!(&both[..at], &filter.apply(&values[..at], &[]).unwrap());
            prop_assert_eq!(&both[at..], &filter.apply(&values[at..], &[]).unwrap());
        }
    }

    #[test]
    fn the_gain_is_that_of_butterworth_squared() {
        for (order, cutoff, frequency) in [(2, 10.0, 10.0), (4, 10.0, 20.0), (8, 30.0, 25.0)] {
            let filter = LowPass::new(order, cutoff, 500.0).unwrap();
            let wave: Vec<f64> = (0..10_000).map(|i| (2.0 * PI * frequency * f64::from(i) / 500.0).cos()).collect();
            let filtered = filter.apply(&wave, &[]).unwrap();
            let (x, y) = wave[3000..7000]
                .iter()
                .zip(&filtered[3000..7000])
                .fold((0.0, 0.0), |(x, y), (w, f)| (x + w * w, y + w * f));
            // warped alike by the bilinear transform
            let ratio = (PI * frequency / 500.0).tan() / (PI * cutoff / 500.0).tan();
            let expected = 1.0 / (1.0 + ratio.powi(2 * order as i32));
            assert!((y / x - expected).abs() < 1e-9, "{order}: {} {expected}", y / x);
        }
    }

    #[test]
    fn the_causal_delay_is_that_of_a_ramp() {
        for order in [2, 4, 6, 8] {
            let filter = LowPass::new(order, 10.0, 500.0).unwrap();
            let mut ramp: Vec<f64> = (0..2000).map(|i| f64::from(i) / 500.0).collect();
            filter.sections.iter().for_each(|section| section.run(&mut ramp));
            assert!((1999.0 / 500.0 - ramp[1999] - filter.causal_delay()).abs() < 1e-12);
        }
    }

    #[test]
    fn refuses() {
        assert_eq!(LowPass::new(3, 1.0, 10.0).unwrap_err().to_string(), "a filter of order 3, expected 2, 4, 6 or 8");
        for (cutoff, rate) in [(0.0, 10.0), (5.0, 10.0), (f64::NAN, 10.0), (1.0, f64::NAN), (1.0, f64::INFINITY)] {
            assert!(matches!(LowPass::new(2, cutoff, rate), Err(LowPassError::Cutoff { .. })));
        }
        let filter = LowPass::new(2, 1.0, 10.0).unwrap();
        assert_eq!(filter.apply(&[], &[]), Ok(vec![]));
        for breaks in [vec![0], vec![3], vec![2, 1], vec![1, 1]] {
            let error = filter.apply(&[0.0; 3], &breaks).unwrap_err().to_string();
            assert!(error.ends_with("of 3, expected growing places between 1 and 2"), "{error}");
        }
        assert!(matches!(filter.apply(&[0.0, f64::NAN], &[]), Err(LowPassError::NotFinite { at: 1, .. })));
    }

    #[test]
    fn samples_with_a_gap() {
        use crate::{Frame, Mounting, Wrench, WrenchSample};
        let pose = rod_core::Pose { x: 0.0, y: 0.0, phi: 0.0 };
        let sample = |t: f64| {
            let wrench = Wrench::from_components([t.sin(), t.cos(), 0.0, 0.0, 0.0, t]);
            Mounting::new(Frame::same()).reactions(&WrenchSample::new(t, wrench), pose)
        };
        let times: Vec<f64> = (0..30).map(|i| 0.1 * f64::from(if i < 20 { i } else { i + 5 })).collect();
        let mut samples: Vec<_> = times.iter().map(|t| sample(*t)).collect();
        let filter = LowPass::new(2, 1.0, 10.0).unwrap();
        let error = filter.apply_to_reactions(&mut samples, &[]).unwrap_err();
        assert!(matches!(error, LowPassError::Uneven { at: 20, .. }));
        filter.apply_to_reactions(&mut samples, &[20]).unwrap();
        let channel: Vec<f64> = times.iter().map(|t| -t.cos()).collect();
        let expected = filter.apply(&channel, &[20]).unwrap();
        assert!(samples.iter().zip(expected).all(|(sample, value)| sample.reactions.f0y == value));
    }
}
