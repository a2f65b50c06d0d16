//! A recording as a fit takes it: means of blocks of samples, cut where the reactions have kinks and jumps.

use crate::kink::KinkKind;
use crate::phase::Label;
use crate::pipeline::{Reading, Reconstruction};
use crate::point::{Clamp, Touch};
use crate::scan::Track;
use crate::systematic::motion;
use nalgebra::Vector3;
use rod_contact::{Contact, ContactKind};
use rod_core::{Rod, Sample};
use std::ops::Range;

/// Blocks into which a recording is divided, more where kinks cut it. More: more time; fewer: less is seen between kinks.
const BLOCKS: usize = 600;
/// Smallest length of a block over the ratio of long-run to sample variance, so that the means of neighbouring blocks are nearly independent.
const INDEPENDENT: f64 = 2.0;
/// Standard deviation of a block over the largest reaction, at least: what the contour of a fit, a cubic spline, and the mean of a block
/// leave of noise-free samples.
const LEAST_NOISE: f64 = 3e-4;
/// Blocks on either side of a jump that are left out: its place is known to a sample, and a real rod rings after it.
const BESIDE_JUMP: usize = 1;

/// The mean of a block of samples, dimensionless.
#[derive(Clone, Debug)]
pub(super) struct Block {
    /// The samples from the first to after the last.
    pub samples: Range<usize>,
    pub tau: f64,
    pub clamp: Clamp,
    /// Rate of the pose along the path.
    pub motion: Vector3<f64>,
    /// Standard deviations of its reactions.
    pub sigma: Vector3<f64>,
    /// What the local answer says of the sample in its middle.
    pub label: Label,
    /// The contacts that it gives, dimensionless; empty where they are not known.
    pub contacts: Vec<Contact>,
    /// Whether it is beside a jump.
    pub is_by_jump: bool,
}

/// The blocks of a recording.
#[derive(Clone, Debug)]
pub(super) struct Blocks {
    pub blocks: Vec<Block>,
    /// Ranges of blocks between jumps and between passes.
    pub segments: Vec<Range<usize>>,
}

/// The usable samples of a pass and how local answers are made dimensionless.
pub(super) struct Pass<'a> {
    pub rod: &'a Rod,
    /// Numbers of all samples of the recording that belong to the pass.
    pub samples: Range<usize>,
    /// Path of the clamp before it, rod lengths and radians.
    pub before: f64,
}

impl Blocks {
    /// Of a recording with its local answers. `rod` has the units of the given rod, `found` is the rod of the local answers.
    pub fn of(rod: &Rod, samples: &[Sample], local: &Reconstruction) -> Self {
        let long_run = local.noise.iter().fold(1.0, |most: f64, channel| most.max(channel.long_run));
        let width = samples.len().div_ceil(BLOCKS).max((INDEPENDENT * long_run) as usize).max(1);
        let width = if local.noise.iter().all(|channel| channel.sigma < f64::MIN_POSITIVE) { 1 } else { width };
        let largest = {
            let most = |of: fn(&Sample) -> f64| {
                samples.iter().map(|s| of(s).abs()).filter(|v| v.is_finite()).fold(0.0, f64::max)
            };
            let units = rod.units();
            let force = most(|s| s.reactions.f0x).max(most(|s| s.reactions.f0y)) / units.force;
            Vector3::new(force, force, most(|s| s.reactions.m0z) / units.moment)
        };
        let mut found = Self { blocks: Vec::new(), segments: Vec::new() };
        let mut before = 0.0;
        for pass in &local.passes {
            let pass = Pass { rod, samples: pass.samples.clone(), before };
            before += found.add_pass(&pass, samples, local, width, &largest);
        }
        found
    }

    /// Adds the blocks of a pass; returns the length of its path.
    fn add_pass(
        &mut self,
        pass: &Pass<'_>,
        samples: &[Sample],
        local: &Reconstruction,
        width: usize,
        largest: &Vector3<f64>,
    ) -> f64 {
        let first = pass.samples.start;
        let (track, numbered) = Track::new(pass.rod, samples.get(pass.samples.clone()).unwrap_or_default());
        let cuts = |jump: bool| {
            local
                .kinks
                .iter()
                .filter(move |kink| !jump || kink.kind == KinkKind::Jump)
                .map(|kink| kink.next)
                .filter(|next| pass.samples.contains(next))
        };
        let jumps: Vec<usize> = cuts(true).collect();
        let mut ends: Vec<usize> = cuts(false).chain([pass.samples.end]).collect();
        ends.sort_unstable();
        ends.dedup();
        let (mut from, mut start, mut after_jump) = (first, self.blocks.len(), false);
        for end in ends {
            for part in (from..end).collect::<Vec<_>>().chunks(width) {
                let index: Vec<usize> =
                    part.iter().filter_map(|k| numbered[k - first].ok()).map(|index| index.0).collect();
                let (Some(range), false) = (part.first().zip(part.last()), index.is_empty()) else { continue };
                let range = *range.0..range.1 + 1;
                self.blocks.push(block(pass, &track, &index, range, local, largest));
            }
            let is_jump = jumps.contains(&end);
            if is_jump || end == pass.samples.end {
                let segment = start..self.blocks.len();
                let beside = |k: usize| {
                    after_jump && k < segment.start + BESIDE_JUMP || is_jump && k + BESIDE_JUMP >= segment.end
                };
                for k in segment.clone().filter(|k| beside(*k)) {
                    self.blocks[k].is_by_jump = true;
                }
                if !segment.is_empty() {
                    self.segments.push(segment);
                }
                (start, after_jump) = (self.blocks.len(), is_jump);
            }
            from = end;
        }
        match (track.tau.first(), track.tau.last()) {
            (Some(from), Some(to)) => to - from,
            _ => 0.0,
        }
    }
}

fn block(
    pass: &Pass<'_>,
    track: &Track,
    index: &[usize],
    samples: Range<usize>,
    local: &Reconstruction,
    largest: &Vector3<f64>,
) -> Block {
    let count = index.len() as f64;
    let mut clamp = track.clamps[index[0]];
    clamp.pose = index.iter().map(|i| track.clamps[*i].pose).sum::<Vector3<f64>>() / count;
    clamp.reactions = index.iter().map(|i| track.clamps[*i].reactions).sum::<Vector3<f64>>() / count;
    let units = pass.rod.units();
    let size = [units.force, units.force, units.moment];
    let sigma = Vector3::from_fn(|c, _| {
        let noise = &local.noise[c];
        // of AR(1) noise with this long-run variance
        let rho = (noise.long_run.max(1.0) - 1.0) / (noise.long_run.max(1.0) + 1.0);
        let factor = ((1.0 + rho) - 2.0 * rho * (1.0 - rho.powf(count)) / (count * (1.0 - rho))) / (1.0 - rho);
        (noise.sigma / size[c] * (factor / count).sqrt()).max(LEAST_NOISE * largest[c]).max(f64::MIN_POSITIVE)
    });
    let middle = &local.readings[samples.start + (samples.end - samples.start) / 2];
    let (length, force) = local.calibration().map_or((units.length, units.force), |calibration| {
        let found = calibration.rod(pass.rod).units();
        (found.length, found.force)
    });
    Block {
        tau: pass.before + index.iter().map(|i| track.tau[*i]).sum::<f64>() / count,
        clamp,
        motion: motion(track, index[index.len() / 2]),
        sigma,
        label: middle.label,
        contacts: contacts(middle, length, force),
        is_by_jump: false,
        samples,
    }
}

/// The contacts of a sample, dimensionless; empty where not all are known.
fn contacts(reading: &Reading, length: f64, force: f64) -> Vec<Contact> {
    let contact = |touch: &Touch, tip: bool| Contact {
        object: 0,
        piece: 0,
        kind: if tip { ContactKind::Tip } else { ContactKind::Tangent },
        s: (touch.s / length).min(1.0),
        x: touch.x / length,
        y: touch.y / length,
        alpha: touch.alpha,
        force: touch.force / force,
        friction: None,
    };
    match (&reading.touch, &reading.second) {
        (Ok(touch), None) if !reading.label.several() => vec![contact(touch, reading.label.tip())],
        (Ok(first), Some(Ok(second))) => vec![contact(first, false), contact(second, reading.label.tip())],
        _ => Vec::new(),
    }
}
