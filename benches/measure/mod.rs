//! Times that can be compared: everything that enters a ratio is measured in turns, in one run.
#![allow(dead_code, reason = "each bench takes what it needs")]

pub mod machine;
pub mod objects;
pub mod slalom;
pub mod solves;
pub mod waves;

use std::f64::consts::PI;
use std::hint::black_box;
use std::ops::RangeBounds;
use std::time::Instant;
use vibrissa::rod::{Section, advance};

/// Seconds a unit of work.
#[derive(Clone, Copy, Debug)]
pub struct Time {
    /// The best round: what the work costs when nothing disturbs it.
    pub least: f64,
    /// The middle round: what it costs here and now.
    pub median: f64,
}

impl Time {
    /// "0.21 us (median 0.23)", in the unit `factor` (1e6 for us) called `name`.
    pub fn show(&self, factor: f64, name: &str) -> String {
        format!("{:9.3} {name} (median {:.3})", self.least * factor, self.median * factor)
    }

    /// How many times as long as `other` this takes: by the best rounds, and by the middle ones.
    pub fn over(&self, other: &Self) -> String {
        format!("{:.1} (medians {:.1})", self.least / other.least, self.median / other.median)
    }
}

/// Times each of `works` `rounds` times, one after the other in every round, so that a busy machine is unfair to all
/// alike. A work returns how many units of it were done.
pub fn interleaved<const N: usize>(rounds: usize, mut works: [&mut dyn FnMut() -> usize; N]) -> [Time; N] {
    let times = in_turns(rounds, &mut works);
    std::array::from_fn(|i| times[i])
}

/// The same for works whose number is not known beforehand.
pub fn in_turns(rounds: usize, works: &mut [&mut dyn FnMut() -> usize]) -> Vec<Time> {
    let mut times = vec![Vec::new(); works.len()];
    for round in 0..=rounds {
        for (work, times) in works.iter_mut().zip(&mut times) {
            let start = Instant::now();
            let units = work();
            let time = start.elapsed().as_secs_f64() / units as f64;
            // the first round warms up
            if round > 0 {
                times.push(time);
            }
        }
    }
    let time = |mut times: Vec<f64>| {
        times.sort_by(f64::total_cmp);
        Time { least: times[0], median: times[times.len() / 2] }
    };
    times.into_iter().map(time).collect()
}

/// Whether a number is where it is claimed to be.
pub fn verdict(claim: &str, number: f64, bounds: impl RangeBounds<f64>) -> String {
    let digits = if number < 100.0 { 2 } else { 0 };
    format!("{claim}: {} ({number:.digits$})", if bounds.contains(&number) { "holds" } else { "DOES NOT HOLD" })
}

/// Whether the bench was started to be timed, not listed or tried once.
pub fn is_timed() -> bool {
    !std::env::args().any(|argument| argument == "--test" || argument == "--list")
}

/// Numbers that are the same in every run.
pub struct Random(pub u64);

impl Random {
    /// Uniform between -`most` and `most`.
    pub fn within(&mut self, most: f64) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        most * ((self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0)
    }
}

/// A segment of a rod: where it starts, its force and its length.
pub struct Segment {
    pub start: Section,
    pub a: f64,
    pub b: f64,
    pub s: f64,
}

/// Random segments in the range in which the kernel's accuracy is claimed: |A|, |B| <= 20, |kappa| <= 6, s <= 1. So many that
/// no branch predictor learns them by heart.
pub fn segments() -> Vec<Segment> {
    let mut random = Random(1);
    let segment = |_| Segment {
        start: Section {
            x: random.within(1.0),
            y: random.within(1.0),
            phi: random.within(PI),
            kappa: random.within(6.0),
        },
        a: random.within(20.0),
        b: random.within(20.0),
        s: random.within(1.0).abs(),
    };
    (0..8192).map(segment).collect()
}

/// Advances along each of the segments: what other times are compared with.
pub fn kernel(segments: &[Segment]) -> usize {
    for Segment { start, a, b, s } in segments {
        black_box(advance(black_box(start), *a, *b, *s));
    }
    segments.len()
}
