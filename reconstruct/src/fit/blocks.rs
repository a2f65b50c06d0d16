//! A recording as a fit takes it: means of blocks of samples, cut where the reactions have kinks and jumps.

use super::jumps::jumps;
use crate::kink::KinkKind;
use crate::phase::Label;
use crate::pipeline::{Reading, Reconstruction};
use crate::point::{Clamp, Touch};
use crate::scan::{Fault, Track, TrackIndex, dimensionless};
use crate::systematic::{Correction, Errors, Frame, motion, still};
use nalgebra::{Matrix2, Vector3};
use rod_contact::{Contact, ContactKind};
use rod_core::{Rod, Sample, Units};
use std::ops::Range;

/// Blocks into which a recording is divided, more where kinks cut it. More: more time; fewer: less is seen between kinks.
const BLOCKS: usize = 600;
/// Smallest length of a block over the ratio of long-run to sample variance, so that the means of neighbouring blocks are nearly independent.
const INDEPENDENT: f64 = 2.0;
/// Standard deviation of a block over the largest reaction, at least: what the contour of a fit, a cubic spline, and the mean of a block
/// leave of noise-free samples.
const LEAST_NOISE: f64 = 3e-4;
/// Standard deviation of the noise of a sample over the largest reaction up to which a recording is exact, as simulations without noise are. Larger: recordings of
/// good sensors are not fitted; smaller: clean points are replaced by those of splines.
const EXACT: f64 = 1e-6;
/// Free blocks whose scatter about their mean is looked at; independent blocks that would tell the noise as well as the model of it does (its variance to
/// 15 %); and the largest ratio of the variances: more is no noise.
const FEW: usize = 10;
const KNOWN_AS: f64 = 100.0;
const MOST_SCATTER: f64 = 2.0;
/// Force of the last block in contact, standard deviations, from which on a free block after it tells of a jump.
const RELEASED: f64 = 100.0;
/// Distance of the reactions of a free block from those at rest, standard deviations, at which the rod rings, and the least number of blocks at rest.
const RINGS: f64 = 6.0;
const QUIET: usize = 4;
/// Blocks on either side of a jump that are left out: its place is known to a sample, and a real rod rings after it.
const BESIDE_JUMP: usize = 1;

/// The mean of a block of samples, dimensionless but for its contacts.
#[derive(Clone, Debug)]
pub(super) struct Block {
    /// The number of its recording.
    pub recording: usize,
    /// The samples from the first to after the last. Those of several recordings are numbered one recording after the other.
    pub samples: Range<usize>,
    pub tau: f64,
    pub clamp: Clamp,
    /// Rate of the pose along the path.
    pub motion: Vector3<f64>,
    /// Half of the way of the pose from its first sample to its last.
    pub half: Vector3<f64>,
    /// 1 where friction draws the rod towards its tip in its pass, -1 where it holds it back.
    pub drawn: f64,
    /// Standard deviations of its reactions.
    pub sigma: Vector3<f64>,
    /// Relative variance of the mean of their squares, which are estimated.
    pub noise_spread: f64,
    /// What the local answer says of the sample in its middle.
    pub label: Label,
    /// The contacts that it gives, SI units of the given rod; empty where they are not known.
    pub contacts: Vec<Contact>,
    /// Covariance of contact points by errors that all samples share, m^2; none where there is no contact point.
    pub systematic: Option<Matrix2<f64>>,
    /// Whether it is left out: it is beside a jump, or the rod rings after one.
    pub is_left_out: bool,
}

/// The blocks of the recordings that are fitted together.
#[derive(Clone, Debug)]
pub(super) struct Blocks {
    pub blocks: Vec<Block>,
    /// Ranges of blocks between jumps and between passes.
    pub segments: Vec<Range<usize>>,
    pub recordings: Vec<Part>,
}

/// One of the recordings.
#[derive(Clone, Debug)]
pub(super) struct Part {
    /// Its samples among all.
    pub samples: Range<usize>,
    pub frame: Frame,
    /// Samples that are left out because the free rod rings.
    pub ringing: usize,
}

/// What all blocks of a recording are made with.
struct Cut<'a> {
    /// The given rod.
    rod: &'a Rod,
    local: &'a Reconstruction,
    /// Units of the rod of the local answers.
    found: Units,
    /// Samples of a block.
    width: usize,
    /// Smallest standard deviations of a block.
    least: Vector3<f64>,
}

/// Parts of at most `width` samples. A clamp that stands still for longer has one of its own: its samples have the same `index`.
fn parts(samples: Range<usize>, width: usize, index: impl Fn(usize) -> Option<usize>) -> Vec<Range<usize>> {
    let standing = |from: usize| {
        let same = (from..samples.end).take_while(|k| index(*k).is_some() && index(*k) == index(from));
        from + same.count()
    };
    let stops = |from: &usize| standing(*from) > from + width;
    let (mut parts, mut start) = (Vec::new(), samples.start);
    while start < samples.end {
        let most = samples.end.min(start + width);
        let end = if stops(&start) { standing(start) } else { (start + 1..most).find(stops).unwrap_or(most) };
        parts.push(start..end);
        start = end;
    }
    parts
}

/// The largest reactions of a recording, dimensionless: forces in any direction count alike.
fn largest(units: Units, samples: &[Sample]) -> Vector3<f64> {
    let most = |of: fn(&Sample) -> f64| {
        samples.iter().map(|sample| of(sample).abs()).filter(|v| v.is_finite()).fold(0.0, f64::max)
    };
    let force = most(|s| s.reactions.f0x).max(most(|s| s.reactions.f0y)) / units.force;
    Vector3::new(force, force, most(|s| s.reactions.m0z) / units.moment)
}

/// Whether the samples of a recording have no noise that a fit could average out.
pub(super) fn is_exact(units: Units, samples: &[Sample], local: &Reconstruction) -> bool {
    let (noise, largest) = (dimensionless(&local.noise, units), largest(units, samples));
    (0..3).all(|c| noise[c].sigma <= EXACT * largest[c])
}

impl Blocks {
    /// Of a recording with its local answers, of which `rod` has the units; none where no sample can be used.
    pub fn of(rod: &Rod, samples: &[Sample], local: &Reconstruction) -> Option<Self> {
        let long_run = local.noise.iter().fold(1.0, |most: f64, channel| most.max(channel.long_run));
        let largest = largest(rod.units(), samples);
        let cut = Cut {
            rod,
            local,
            found: local.calibration().map_or(rod.units(), |calibration| calibration.rod(rod).units()),
            width: samples.len().div_ceil(BLOCKS).max((INDEPENDENT * long_run) as usize),
            least: largest * LEAST_NOISE,
        };
        let (mut blocks, mut segments, mut before, mut frame) = (Vec::new(), Vec::new(), 0.0, None);
        for pass in &local.passes {
            let (track, indices) = Track::new(rod, samples.get(pass.samples.clone()).unwrap_or_default());
            let Some((own, (from, to))) = Frame::of(&track).zip(track.tau.first().zip(track.tau.last())) else {
                continue;
            };
            frame = frame.or(Some(own));
            let first = blocks.len();
            cut.pass(pass.samples.clone(), before, (&track, &indices), &mut blocks, &mut segments);
            blocks[first..].iter_mut().for_each(|block: &mut Block| block.drawn = pass.drawn());
            before += to - from;
        }
        as_scattered(&mut blocks);
        let segments = cut_at_releases(&mut blocks, segments);
        let ringing = leave_out_ringing(&mut blocks, &segments);
        let (first, last) = (blocks.first().map(|block: &Block| block.tau)?, blocks.last()?.tau);
        let part = Part { samples: 0..samples.len(), frame: frame?.on_way(last - first), ringing };
        Some(Self { blocks, segments, recordings: vec![part] })
    }

    /// With those of another recording after them.
    pub fn and(mut self, other: Self) -> Self {
        let (recordings, blocks) = (self.recordings.len(), self.blocks.len());
        let samples = self.recordings.last().map_or(0, |last| last.samples.end);
        let after = |range: Range<usize>, first: usize| range.start + first..range.end + first;
        self.blocks.extend(other.blocks.into_iter().map(|block| Block {
            recording: block.recording + recordings,
            samples: after(block.samples.clone(), samples),
            ..block
        }));
        self.segments.extend(other.segments.into_iter().map(|segment| after(segment, blocks)));
        let moved = |part: Part| Part { samples: after(part.samples.clone(), samples), ..part };
        self.recordings.extend(other.recordings.into_iter().map(moved));
        self
    }

    /// What takes the errors of each recording off its blocks; none where gains and cross-talk leave fewer than three channels.
    pub fn corrections(&self, errors: &[Errors]) -> Option<Vec<Correction>> {
        self.recordings.iter().zip(errors).map(|(part, errors)| Correction::new(part.frame, errors)).collect()
    }
}

impl Block {
    /// Pose and reactions that it may have, without errors.
    pub fn corrected(&self, clamp: &Clamp, correction: &Correction) -> Clamp {
        let clamp = correction.apply(self.tau, clamp, &still(self.motion)).0;
        Clamp { friction: self.drawn * clamp.friction, ..clamp }
    }

    /// Size of its reactions less others, in standard deviations.
    fn off(&self, reactions: &Vector3<f64>) -> f64 {
        (self.clamp.reactions - reactions).component_div(&self.sigma).norm()
    }
}

/// Cuts segments where a rod under force is free from one block to the next: it has jumped, though ringing may hide the jump.
fn cut_at_releases(blocks: &mut [Block], segments: Vec<Range<usize>>) -> Vec<Range<usize>> {
    let mut cut = Vec::with_capacity(segments.len());
    for Range { mut start, end } in segments {
        for k in start + 1..end {
            let is_released = blocks[k].label == Label::Free && blocks[k - 1].label != Label::Free;
            if is_released && blocks[k - 1].off(&Vector3::zeros()) > RELEASED {
                blocks[k - 1..=k].iter_mut().for_each(|block| block.is_left_out = true);
                cut.push(start..k);
                start = k;
            }
        }
        cut.push(start..end);
    }
    cut
}

/// Leaves out blocks after a jump, where a free rod rings: until its reactions stay what they are at the end of the segment. How many samples these are.
fn leave_out_ringing(blocks: &mut [Block], segments: &[Range<usize>]) -> usize {
    let mut count = 0;
    for segment in segments.iter().skip(1).filter(|segment| segment.len() > 2 * QUIET) {
        let own = &mut blocks[segment.clone()];
        if own.iter().any(|block| block.label != Label::Free) {
            continue;
        }
        let half = &own[own.len() / 2..];
        let rest = half.iter().map(|block| block.clamp.reactions).sum::<Vector3<f64>>() / half.len() as f64;
        let rings = own.iter().rposition(|block| block.off(&rest) > RINGS).map_or(0, |last| last + 1);
        if rings + QUIET <= own.len() {
            own[..rings].iter_mut().for_each(|block| block.is_left_out = true);
            count += own[..rings].iter().map(|block| block.samples.len()).sum::<usize>();
        }
    }
    count
}

/// Makes the standard deviations larger where the means of free blocks scatter by more about the mean of each few of them: of short recordings the
/// correlation of the noise is hardly known.
fn as_scattered(blocks: &mut [Block]) {
    let (mut sum, mut count) = (Vector3::zeros(), 0.0);
    for few in blocks.chunks_exact(FEW).filter(|few| few.iter().all(|one| one.label == Label::Free && !one.is_left_out))
    {
        let z: Vec<Vector3<f64>> = few.iter().map(|block| block.clamp.reactions.component_div(&block.sigma)).collect();
        let mean = z.iter().sum::<Vector3<f64>>() / FEW as f64;
        sum += z.iter().map(|z| (z - mean).component_mul(&(z - mean))).sum::<Vector3<f64>>();
        count += (FEW - 1) as f64;
    }
    let factor = sum.map(|sum| ((sum + KNOWN_AS) / (count + KNOWN_AS)).clamp(1.0, MOST_SCATTER).sqrt());
    blocks.iter_mut().for_each(|block| block.sigma.component_mul_assign(&factor));
}

impl Blocks {
    /// The parts of segments along which each block is one of `asked`.
    pub fn runs(&self, asked: &[bool]) -> Vec<Range<usize>> {
        let mut runs = Vec::new();
        for segment in &self.segments {
            let mut start = segment.start;
            while start < segment.end {
                let end = (start..segment.end).find(|k| asked[*k] != asked[start]).unwrap_or(segment.end);
                if asked[start] {
                    runs.push(start..end);
                }
                start = end;
            }
        }
        runs
    }

    /// The segment of a block.
    pub fn segment_of(&self, block: usize) -> Range<usize> {
        let segment = self.segments.iter().find(|segment| segment.contains(&block));
        segment.cloned().unwrap_or(block..block + 1)
    }
}

impl Cut<'_> {
    /// Adds the blocks and segments of the pass with these samples. The clamp has gone `before` until then.
    fn pass(
        &self,
        samples: Range<usize>,
        before: f64,
        (track, indices): (&Track, &[Result<TrackIndex, Fault>]),
        blocks: &mut Vec<Block>,
        segments: &mut Vec<Range<usize>>,
    ) {
        let mut cuts: Vec<(usize, bool)> = self
            .local
            .kinks
            .iter()
            .filter(|kink| samples.contains(&kink.next))
            .map(|kink| (kink.next, kink.kind == KinkKind::Jump))
            .collect();
        let found = jumps(track, &dimensionless(&self.local.noise, self.rod.units()));
        let sample = |jump: usize| indices.iter().position(|index| matches!(index, Ok(TrackIndex(i)) if *i == jump));
        cuts.extend(found.into_iter().filter_map(sample).map(|k| (samples.start + k, true)));
        cuts.sort_unstable();
        // where several lie before one sample, a jump is the last of them
        cuts.reverse();
        cuts.dedup_by_key(|cut| cut.0);
        cuts.reverse();
        let (mut from, mut start, mut after_jump) = (samples.start, blocks.len(), false);
        for (end, is_jump) in cuts.into_iter().chain([(samples.end, false)]) {
            let index = |k: usize| indices[k - samples.start].as_ref().ok().map(|index| index.0);
            for part in parts(from..end, self.width, index) {
                let usable = indices[part.start - samples.start..part.end - samples.start].iter();
                let usable: Vec<usize> = usable.filter_map(|index| Some(index.ok()?.0)).collect();
                if !usable.is_empty() {
                    blocks.push(self.block(part, before, track, &usable));
                }
            }
            if is_jump || end == samples.end {
                let segment = start..blocks.len();
                for k in segment.clone() {
                    blocks[k].is_left_out =
                        after_jump && k < segment.start + BESIDE_JUMP || is_jump && k + BESIDE_JUMP >= segment.end;
                }
                if !segment.is_empty() {
                    segments.push(segment);
                }
                (start, after_jump) = (blocks.len(), is_jump);
            }
            from = end;
        }
    }

    /// The block of some samples, which have these indices in the track.
    fn block(&self, samples: Range<usize>, before: f64, track: &Track, usable: &[usize]) -> Block {
        let count = usable.len() as f64;
        let mut clamp = track.clamps[usable[0]];
        clamp.pose = usable.iter().map(|i| track.clamps[*i].pose).sum::<Vector3<f64>>() / count;
        clamp.reactions = usable.iter().map(|i| track.clamps[*i].reactions).sum::<Vector3<f64>>() / count;
        let noise = dimensionless(&self.local.noise, self.rod.units());
        let sigma = Vector3::from_fn(|c, _| {
            // of AR(1) noise with this long-run variance
            let long_run = noise[c].long_run.max(1.0);
            let rho = (long_run - 1.0) / (long_run + 1.0);
            let factor = ((1.0 + rho) - 2.0 * rho * (1.0 - rho.powf(count)) / (count * (1.0 - rho))) / (1.0 - rho);
            (noise[c].sigma * (factor / count).sqrt()).max(self.least[c]).max(f64::MIN_POSITIVE)
        });
        let middle = &self.local.readings[samples.start + (samples.end - samples.start) / 2];
        Block {
            recording: 0,
            tau: before + usable.iter().map(|i| track.tau[*i]).sum::<f64>() / count,
            clamp,
            motion: motion(track, usable[usable.len() / 2]),
            drawn: 1.0,
            half: 0.5 * (track.clamps[usable[usable.len() - 1]].pose - track.clamps[usable[0]].pose),
            sigma,
            // the channels are independent
            noise_spread: noise.iter().map(|channel| channel.spread).sum::<f64>() / 9.0,
            label: middle.label,
            contacts: self.contacts(middle),
            systematic: middle.touch.ok().map(|touch| touch.systematic),
            is_left_out: false,
            samples,
        }
    }

    /// The contacts of a sample in units of the given rod; empty where not all are known.
    fn contacts(&self, reading: &Reading) -> Vec<Contact> {
        let (found, given) = (self.found, self.rod.units());
        let in_lengths = |v: f64| v / found.length * given.length;
        let contact = |(touch, tip): (Touch, bool)| Contact {
            kind: if tip { ContactKind::Tip } else { ContactKind::Tangent },
            s: in_lengths(touch.s).min(given.length),
            x: in_lengths(touch.x),
            y: in_lengths(touch.y),
            force: touch.force / found.force * given.force,
            ..touch.into()
        };
        reading.touches().unwrap_or_default().into_iter().map(contact).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_clamp_that_stands_still_has_a_block_of_its_own() {
        let index = |k: usize| (k != 11).then(|| if k < 5 { k } else { k.saturating_sub(9).max(5) });
        // samples 5 to 14 are at one place
        let found = parts(0..20, 3, |k| if k == 4 { None } else { index(k) });
        assert_eq!(found, [0..3, 3..5, 5..11, 11..14, 14..17, 17..20]);
        assert_eq!(parts(3..10, 4, Some), [3..7, 7..10]);
    }
}
