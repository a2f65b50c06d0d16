//! Axes, signs and units of reactions, as the physics prefers them.
//!
//! Forces have eight sets of axes and signs in the plane, the moment has two signs. In each of the sixteen frames a single frictionless
//! contact satisfies one of two conditions in all samples: m0z^2 = 2 EI (f0y sin phi0 + f0x cos phi0), or the contact is at the tip
//! (Merker et al. 2020, eq. 18 and 20). These conditions do not change where the rod and all loads are mirrored about the clamp's axis; the
//! work of the clamp does, which must be the change of the elastic energy. Without a rod the stiffness is that of the line of tangential
//! contacts, and the length that of the contacts off this line.

use super::agreement::{FEWEST, SIGMAS, agreement};
use vibrissa::Rod;
use vibrissa::Sample;
use vibrissa::reconstruct::noise_estimate::estimate;
use vibrissa::reconstruct::plausibility;
use vibrissa::rod::Reactions;

/// Most averages of consecutive samples. More: more time; fewer: short phases are averaged out.
const MOST: usize = 300;
/// Share of the averages that satisfy one of the conditions in the preferred frame, at least.
pub(super) const SHARE: f64 = 0.7;
/// Difference of the scores of the best two frames, at least. Scores are at most 3.
pub(super) const MARGIN: f64 = 0.3;
/// With a correlation of work and energy of this size, at least, and so much above that of the second frame, the conditions need not be satisfied: friction, a
/// taper and springs spoil them, the work hardly.
const WORK: f64 = 0.7;
const WORK_MARGIN: f64 = 0.3;
/// The unit is another one where the slope of the line is within this factor of that of the rod in that unit.
pub(super) const NEAR: f64 = 2.0;

/// A frame of the reactions: which column is which, and with what sign.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct ReactionFrame {
    /// Whether f0x is the column of y and f0y that of x.
    pub swapped: bool,
    /// Whether the signs of f0x, f0y, m0z, as they result, are turned.
    pub turned: [bool; 3],
}

impl ReactionFrame {
    const AS_IS: Self = Self { swapped: false, turned: [false; 3] };

    fn all() -> impl Iterator<Item = Self> {
        (0..16_u8).map(|k| Self { swapped: k & 8 > 0, turned: [k & 1 > 0, k & 2 > 0, k & 4 > 0] })
    }

    pub fn is_as_is(self) -> bool {
        self == Self::AS_IS
    }

    /// Loads on the sensor in place of reactions of the clamp.
    pub fn is_load(self) -> bool {
        !self.swapped && self.turned == [true; 3]
    }

    fn of(self, Reactions { f0x, f0y, m0z }: Reactions) -> Reactions {
        let [x, y, z] = self.turned.map(|turned| if turned { -1.0 } else { 1.0 });
        let (f0x, f0y) = if self.swapped { (f0y, f0x) } else { (f0x, f0y) };
        Reactions { f0x: x * f0x, f0y: y * f0y, m0z: z * m0z }
    }

    fn samples(self, samples: &[Sample]) -> Vec<Sample> {
        samples.iter().map(|sample| Sample { reactions: self.of(sample.reactions), ..*sample }).collect()
    }

    /// In words, where the columns are called so.
    pub fn text(self, names: [&str; 3]) -> String {
        let [x, y, z] = if self.swapped { [names[1], names[0], names[2]] } else { names };
        // a name of loads begins with a minus itself
        let signed = |turned: bool, name: &str| match (turned, name.strip_prefix('-')) {
            (true, Some(name)) => name.to_owned(),
            (true, None) => format!("-{name}"),
            (false, _) => name.to_owned(),
        };
        let [a, b, c] = self.turned;
        format!("f0x = {}, f0y = {}, m0z = {}", signed(a, x), signed(b, y), signed(c, z))
    }
}

/// A frame with how well it explains the samples.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rated {
    pub frame: ReactionFrame,
    /// Share of the averages that satisfy one of the two conditions.
    pub explained: f64,
    /// Share that some single contact explains.
    pub possible: f64,
    /// Correlation of the work of the clamp and the change of the energy.
    pub energy: f64,
    /// Bending stiffness of the line over that of the rod, in the units found; 1 without either.
    pub stiffness: f64,
    /// N and N m of the units of forces and moments that fit the rod.
    pub units: [f64; 2],
}

impl Rated {
    pub fn score(&self) -> f64 {
        self.explained + self.possible + self.energy
    }
}

/// The frame that the physics prefers.
#[derive(Clone, Copy, Debug)]
pub(super) struct FrameVerdict {
    pub best: Rated,
    pub second: Rated,
    /// Whether the best is so much better that it can be relied on.
    pub is_decided: bool,
    /// Means of the reactions over the first samples, where these are steady and not 0: an offset, which was subtracted.
    pub offset: Option<[f64; 3]>,
}

/// What is known before.
#[derive(Clone, Copy, Debug)]
pub(super) struct Before<'r> {
    pub rod: Option<&'r Rod>,
    /// Whether the units of forces and moments are known.
    pub units: [bool; 2],
}

/// The frame of samples; none where too few are in contact. Reactions whose unit is not known are taken as N and N m.
pub(super) fn frame(samples: &[Sample], before: Before<'_>) -> Option<FrameVerdict> {
    let (averages, noise, offset) = averages(samples)?;
    // the line depends on the order and the relative sign of the forces; the slope changes its sign with both
    let lines = [false, true].map(|swapped| {
        [false, true].map(|opposite| slope(&averages, ReactionFrame { swapped, turned: [false, opposite, false] }))
    });
    let slope = |frame: ReactionFrame| {
        let [x, y, _] = frame.turned;
        let slope = lines[usize::from(frame.swapped)][usize::from(x != y)];
        slope.map(|slope| if x { -slope } else { slope }).filter(|slope| *slope > 0.0)
    };
    let mut rated: Vec<Rated> =
        ReactionFrame::all().filter_map(|frame| rate(&averages, noise, frame, slope(frame), before)).collect();
    rated.sort_by(|a, b| b.score().total_cmp(&a.score()));
    let [best, second] = [*rated.first()?, *rated.get(1)?];
    let by_work = best.energy >= WORK
        && best.energy - second.energy >= WORK_MARGIN
        && rated.iter().all(|other| other.energy <= best.energy);
    let is_decided =
        (best.explained >= SHARE && best.energy > 0.0 || by_work) && best.score() - second.score() >= MARGIN;
    let verdict = FrameVerdict { best, second, is_decided, offset };
    match before.rod {
        // in units that the rod contradicts the recording may still agree with itself
        Some(rod) if !is_decided => {
            let alone = frame(samples, Before { rod: None, ..before }).filter(|alone| alone.is_decided);
            let with_ratio = |mut alone: FrameVerdict| {
                alone.best.stiffness = slope(alone.best.frame)? / rod.bending_stiffness();
                Some(alone)
            };
            Some(alone.and_then(with_ratio).unwrap_or(verdict))
        }
        _ => Some(verdict),
    }
}

/// Means of consecutive samples less the offset, the standard deviations of the reactions in them, and the offset, if there is one.
type Averages = (Vec<Sample>, [f64; 3], Option<[f64; 3]>);

fn averages(samples: &[Sample]) -> Option<Averages> {
    let channels: [fn(&Sample) -> f64; 3] = [|s| s.reactions.f0x, |s| s.reactions.f0y, |s| s.reactions.m0z];
    let count: Vec<f64> = (0..samples.len()).map(|k| k as f64).collect();
    let length = samples.len().div_ceil(MOST).max(1);
    let (mut offset, mut is_steady) = ([0.0; 3], true);
    let mut of_channel = 0..3_usize;
    let noise = channels.map(|channel| {
        let values: Vec<f64> = samples.iter().map(channel).collect();
        let found = estimate(&count, &values);
        if let (Some(number), Some(start)) = (of_channel.next(), Start::of(&values, found.sigma)) {
            is_steady &= start.is_steady;
            offset[number] = if start.is_offset { start.mean } else { 0.0 };
        }
        let long_run = if length > 1 { found.long_run.max(1.0) } else { 1.0 };
        found.sigma * (long_run / length as f64).sqrt()
    });
    let offset = Some(offset).filter(|offset| is_steady && *offset != [0.0; 3]);
    let taken = offset.unwrap_or_default();
    let averages: Vec<Sample> = samples
        .chunks(length)
        .map(|part| {
            let mean = |of: &dyn Fn(&Sample) -> f64| part.iter().map(of).sum::<f64>() / part.len() as f64;
            let [f0x, f0y, m0z] = [0, 1, 2].map(|number: usize| mean(&channels[number]) - taken[number]);
            let [x, y, phi] = [mean(&|s| s.pose.x), mean(&|s| s.pose.y), mean(&|s| s.pose.phi)];
            Sample::new(vibrissa::Pose { x, y, phi }, Reactions { f0x, f0y, m0z })
        })
        .filter(|sample| {
            let Reactions { f0x, f0y, m0z } = sample.reactions;
            [sample.pose.x, sample.pose.y, sample.pose.phi, f0x, f0y, m0z].iter().all(|value| value.is_finite())
        })
        .collect();
    (averages.len() > FEWEST).then_some((averages, noise, offset))
}

/// The first samples of a channel.
struct Start {
    mean: f64,
    /// Whether they vary no more than the noise: the rod is free there.
    is_steady: bool,
    /// Whether their mean differs from 0 by more than the noise.
    is_offset: bool,
}

impl Start {
    /// Share of the samples that is the start.
    const PART: usize = 50;
    /// Fewest samples of a start.
    const FEWEST: usize = 8;
    /// Smallest offset, relative to the range of the channel, that matters.
    const SMALLEST: f64 = 2e-3;

    fn of(values: &[f64], sigma: f64) -> Option<Self> {
        let first = values.get(..(values.len() / Self::PART).max(Self::FEWEST))?;
        let count = first.len() as f64;
        let mean = first.iter().sum::<f64>() / count;
        let spread = (first.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / count).sqrt();
        let range = values.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], v| [a.min(*v), b.max(*v)]);
        let range = range[1] - range[0];
        Some(Self {
            mean,
            is_steady: spread <= 1.5 * sigma + 1e-6 * range,
            is_offset: mean.abs() > SIGMAS * sigma / count.sqrt() && mean.abs() > Self::SMALLEST * range,
        })
    }
}

/// Slope of the line of tangential contacts, if there is one.
fn slope(averages: &[Sample], frame: ReactionFrame) -> Option<f64> {
    let samples: Vec<Sample> = frame.samples(averages);
    Some(plausibility(&Rod::new(1.0, 1.0).ok()?, &samples).line?.slope)
}

fn rate(
    averages: &[Sample],
    noise: [f64; 3],
    frame: ReactionFrame,
    slope: Option<f64>,
    before: Before<'_>,
) -> Option<Rated> {
    let samples = frame.samples(averages);
    let (units, stiffness) = match (before.rod, slope) {
        (Some(rod), Some(slope)) => units(slope / rod.bending_stiffness(), before.units),
        _ => ([1.0; 2], 1.0),
    };
    let scaled = |sample: &Sample| {
        let Reactions { f0x, f0y, m0z } = sample.reactions;
        let reactions = Reactions { f0x: units[0] * f0x, f0y: units[0] * f0y, m0z: units[1] * m0z };
        Sample { reactions, ..*sample }
    };
    let samples: Vec<Sample> = samples.iter().map(scaled).collect();
    let swapped = if frame.swapped { [noise[1], noise[0], noise[2]] } else { noise };
    let noise = [units[0] * swapped[0].max(swapped[1]), units[1] * swapped[2]];
    let stiff = match before.rod {
        Some(rod) => rod.bending_stiffness() * if (0.5..2.0).contains(&stiffness) { stiffness } else { 1.0 },
        None => slope?,
    };
    let length = before.rod.map(Rod::length);
    let (explained, possible, energy) = agreement(&samples, noise, stiff, length)?;
    Some(Rated { frame, explained, possible, energy, stiffness, units })
}

/// Units of forces and moments, and what remains of the ratio of the line's slope to the stiffness in them.
fn units(ratio: f64, known: [bool; 2]) -> ([f64; 2], f64) {
    let forces: &[f64] = if known[0] { &[1.0] } else { &[1.0, 1e-3] };
    let moments: &[f64] = if known[1] { &[1.0] } else { &[1.0, 1e-3, 1e-6] };
    let all = forces.iter().flat_map(|force| moments.iter().map(move |moment| [*force, *moment]));
    let rest = |units: [f64; 2]| ratio * units[1].powi(2) / units[0];
    let best = all.min_by(|a, b| rest(*a).ln().abs().total_cmp(&rest(*b).ln().abs())).unwrap_or([1.0; 2]);
    let is_near = rest(best).ln().abs() < NEAR.ln();
    if is_near { (best, rest(best)) } else { ([1.0; 2], ratio) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Interrupt, Scene, Simulation};
    use vibrissa::Pose;
    use vibrissa::reconstruct::NoiseModel;

    const SCENE: &str = "
        [rod]\nlength = 0.1\nbending_stiffness = 6.32e-4
        [contact]\nfriction = FRICTION
        [[contour.piece]]\nshape = 'parabola'\nvertex = [0.0, 0.0]\ncoefficient = 50.0
        [[contour.piece]]\nshape = 'parabola'\nvertex = [0.03, 0.0]\ncoefficient = 50.0
        [sweep]\nfrom = [0.07, -0.04]\nto = [-0.06, -0.04]\nangle = 90.0\nstep = 1e-3";

    /// A scan with friction and noise.
    fn scan(friction: f64, noise: NoiseModel) -> Vec<Sample> {
        let scene = Scene::parse("scene.toml".as_ref(), &SCENE.replace("FRICTION", &friction.to_string())).unwrap();
        let simulation = Simulation { scene, noise, rate: 20.0, speed: 2e-3, seed: 7, sigmas: false };
        let mut text = Vec::new();
        simulation.write_to(&mut text, &Interrupt::default()).unwrap();
        let text = String::from_utf8(text).unwrap();
        let row = |line: &str| {
            let cells: Vec<f64> = line.split(',').map_while(|cell| cell.parse().ok()).collect();
            let [_, x, y, phi, f0x, f0y, m0z] = cells[..] else { return None };
            Some(Sample::new(Pose { x, y, phi }, Reactions { f0x, f0y, m0z }))
        };
        text.lines().filter_map(row).collect()
    }

    /// How many of four frames are found; none that is decided is wrong.
    fn found(samples: &[Sample], rod: Option<&Rod>) -> usize {
        let is_right = |told: ReactionFrame| {
            // the samples as a file in this frame has them: signs first, then the order
            let [x, y, z] = told.turned.map(|turned| if turned { -1.0 } else { 1.0 });
            let of_file = |sample: &Sample| {
                let Reactions { f0x, f0y, m0z } = sample.reactions;
                let (a, b) = if told.swapped { (y * f0y, x * f0x) } else { (x * f0x, y * f0y) };
                Sample { reactions: Reactions { f0x: a, f0y: b, m0z: z * m0z }, ..*sample }
            };
            let file: Vec<Sample> = samples.iter().map(of_file).collect();
            let Some(verdict) = frame(&file, Before { rod, units: [true; 2] }) else { return false };
            assert!(!verdict.is_decided || verdict.best.frame == told, "{told:?}: {verdict:?}");
            verdict.is_decided
        };
        ReactionFrame::all().step_by(5).filter(|frame| is_right(*frame)).count()
    }

    fn all(force: f64, moment: f64) -> Reactions {
        Reactions { f0x: force, f0y: force, m0z: moment }
    }

    #[test]
    fn every_frame_is_found_in_noise_with_an_offset_and_with_friction() {
        let rod = Rod::new(0.1, 6.32e-4).unwrap();
        let noise = NoiseModel { white: all(2.5e-3, 6e-5), ..NoiseModel::default() };
        let of = |change: fn(&mut NoiseModel)| {
            let mut changed = noise.clone();
            change(&mut changed);
            changed
        };
        for (friction, noise) in [
            (0.0, NoiseModel::default()),
            (0.0, noise.clone()),
            (0.0, of(|noise| noise.white = all(1e-2, 3e-4))),
            (0.0, of(|noise| noise.offset = all(2e-2, 5e-4))),
            (0.2, noise.clone()),
        ] {
            let samples = scan(friction, noise.clone());
            let found = (found(&samples, Some(&rod)), found(&samples, None));
            // with friction no line tells the stiffness
            assert_eq!(found, (4, if friction > 0.0 { 0 } else { 4 }), "{friction} {noise:?}");
        }
    }

    #[test]
    fn units_are_those_of_the_stiffness() {
        let rod = Rod::new(0.1, 6.32e-4).unwrap();
        let samples = scan(0.0, NoiseModel::default());
        for (force, moment) in [(1.0, 1.0), (1e-3, 1.0), (1.0, 1e-3), (1e-3, 1e-3), (1.0, 1e-6)] {
            let of_file = |sample: &Sample| {
                let Reactions { f0x, f0y, m0z } = sample.reactions;
                Sample { reactions: Reactions { f0x: f0x / force, f0y: f0y / force, m0z: m0z / moment }, ..*sample }
            };
            let file: Vec<Sample> = samples.iter().map(of_file).collect();
            let verdict = frame(&file, Before { rod: Some(&rod), units: [false; 2] }).unwrap();
            assert!(verdict.is_decided && verdict.best.frame.is_as_is(), "{verdict:?}");
            assert_eq!(verdict.best.units, [force, moment], "{verdict:?}");
        }
    }
}
