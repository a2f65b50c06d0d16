//! Kinks and jumps as the samples come.

use super::scale::{KinkOptions, reach};
use super::search::Detector;
use super::transition::Kink;
use crate::scan::noise_estimate::ChannelNoise;
use std::collections::VecDeque;

/// [`find_kinks`](super::find_kinks) sample by sample. The search runs over the last samples each time that half of the longest
/// half-window has come in, and reports transitions that have a whole half-window of samples on either side.
///
/// It finds the transitions that a search of the whole recording finds, except where those depend on neighbours farther away than a
/// half-window. All memory is allocated in [`new`](Self::new).
///
/// ```
/// use rod_reconstruct::kink::{KinkFilter, KinkOptions};
/// use rod_reconstruct::noise_estimate::ChannelNoise;
/// let options = KinkOptions { widest: 0.01, ..KinkOptions::default() };
/// let mut filter = KinkFilter::new(1e-4, [ChannelNoise::white(1e-6); 3], options, 1000);
/// let mut found = Vec::new();
/// for i in 0..1000 {
///     let tau = 1e-4 * f64::from(i);
///     let bent = (tau - 0.05).max(0.0);
///     found.extend(filter.push(tau, [bent, tau - 2.0 * bent, 1.0]));
/// }
/// found.extend(std::iter::from_fn(|| filter.finish()));
/// assert_eq!(found.len(), 1);
/// assert!((found[0].tau - 0.05).abs() < 1e-6 && found[0].next == 501);
/// ```
#[derive(Clone, Debug)]
pub struct KinkFilter {
    detector: Detector,
    tau: Vec<f64>,
    channels: [Vec<f64>; 3],
    /// Samples before the first in memory.
    passed: usize,
    /// Samples up to which all transitions have been reported.
    decided: usize,
    margin: usize,
    hop: usize,
    nominal: usize,
    pending: VecDeque<Kink>,
    last: Option<Kink>,
}

/// A transition within this many samples or standard deviations of the last one is the same, found again by the next search.
const APART: f64 = 5.0;

impl KinkFilter {
    /// For samples at distances of about `spacing` (> 0, in units of the path parameter). The false-alarm rate of
    /// `options` is that of `nominal` samples.
    pub fn new(spacing: f64, noise: [ChannelNoise; 3], options: KinkOptions, nominal: usize) -> Self {
        let (margin, largest) = reach(spacing, options);
        let hop = largest * (margin / (2 * largest)).max(1);
        let capacity = 2 * margin + hop;
        let detector = Detector::new(capacity, spacing, noise, options).roomy(capacity);
        let room = || Vec::with_capacity(capacity);
        Self {
            detector,
            tau: room(),
            channels: [room(), room(), room()],
            passed: 0,
            decided: 0,
            margin,
            hop,
            nominal,
            pending: VecDeque::with_capacity(capacity),
            last: None,
        }
    }

    /// The largest number of samples after which a transition is found: the longest half-window and the half of it that is searched
    /// at once. Of several that are found at once, one is returned per sample.
    pub fn delay(&self) -> usize {
        self.margin + self.hop
    }

    /// Takes a sample and returns the next transition that was found. Its `next` counts the samples taken.
    pub fn push(&mut self, tau: f64, channels: [f64; 3]) -> Option<Kink> {
        let increases = self.tau.last().is_none_or(|last| tau > *last);
        if !tau.is_finite() || !increases || channels.iter().any(|y| !y.is_finite()) {
            return self.pending.pop_front();
        }
        self.tau.push(tau);
        for (memory, y) in self.channels.iter_mut().zip(channels) {
            memory.push(y);
        }
        if self.tau.len() == 2 * self.margin + self.hop {
            self.search(self.margin + self.hop);
            self.tau.drain(..self.hop);
            self.channels.iter_mut().for_each(|memory| drop(memory.drain(..self.hop)));
            self.passed += self.hop;
        }
        self.pending.pop_front()
    }

    /// Ends the recording: returns the remaining transitions, one per call.
    pub fn finish(&mut self) -> Option<Kink> {
        if self.decided < self.passed + self.tau.len() {
            self.search(self.tau.len());
        }
        self.pending.pop_front()
    }

    /// Decides on the samples in memory up to `end`.
    fn search(&mut self, end: usize) {
        let [a, b, c] = &self.channels;
        self.detector.run(&self.tau, [a, b, c], self.nominal);
        // a transition that an earlier search placed just beyond its end may now be placed just before it
        let from = self.decided.saturating_sub(self.margin / 8);
        for kink in self.detector.transitions() {
            let kink = Kink { next: kink.next + self.passed, ..kink };
            let near = |last: Kink| {
                let samples = kink.next.abs_diff(last.next) <= APART as usize;
                samples || (kink.tau - last.tau).abs() <= APART * (kink.sigma_tau + last.sigma_tau)
            };
            let after = self.last.is_none_or(|last| kink.tau > last.tau);
            if (from..self.passed + end).contains(&kink.next) && after && !self.last.is_some_and(near) {
                self.pending.push_back(kink);
                self.last = Some(kink);
            }
        }
        self.decided = self.passed + end;
    }
}
