//! Axes, signs and units of reactions, as the physics prefers them.
//!
//! Forces have eight sets of axes and signs in the plane, the moment has two signs. In each of the sixteen frames a single frictionless
//! contact satisfies one of two conditions in all samples: m0z^2 = 2 EI (f0y sin phi0 + f0x cos phi0), or the contact is at the tip
//! (Merker et al. 2020, eq. 18 and 20). These conditions do not change where the rod and all loads are mirrored about the clamp's axis; the
//! work of the clamp does, which must be the change of the elastic energy, in sign and size. Without a rod the stiffness is that of the line of
//! tangential contacts, and the length that of the contacts off this line.
//!
//! Hypotheses are the sixteen frames, each with coordinates and angle of the clamp reversed or not, and with each unit that may be. A sensor
//! and a stage that are mirrored against each other leave open which of both is: the prior probabilities decide, or the user.

use super::agreement::{Agreement, FEWEST, SIGMAS, agreement};
use vibrissa::Rod;
use vibrissa::Sample;
use vibrissa::reconstruct::noise_estimate::estimate;
use vibrissa::reconstruct::plausibility;
use vibrissa::rod::Reactions;

/// Most averages of consecutive samples. More: more time; fewer: short phases are averaged out.
const MOST: usize = 300;
/// Share of the averages that satisfy one of the conditions under a hypothesis that explains the recording, at least.
const SHARE: f64 = 0.7;
/// The concordance of work and energy then, at least. Work ten times too large has 0.2, and 2.5 times 0.7; the best of wrong hypotheses had
/// 0.44 where phi0 was wrong by 90 degrees, and where all reactions were twice too large.
const WEAK_WORK: f64 = 0.5;
/// With this concordance fewer need to satisfy the conditions: friction, a taper and springs spoil them, the work hardly. A friction of 0.2 left
/// 20 %. Where objects are on both sides of the rod, 3 to 10 % satisfy them, and the work of wrong frames had a concordance of up to 0.88.
pub(super) const WORK: f64 = 0.7;
const FEW: f64 = 0.15;
/// Number of independent observations that each of the three measures of agreement is worth. Consecutive samples are not independent,
/// and contacts that are not single spoil many of them alike. Larger: more is decided, and more of it wrongly.
const INDEPENDENT: f64 = 10.0;
/// Logarithm of the ratio of the probabilities of the best and the next hypothesis from which on the best is relied on: 20 to 1.
pub(super) const MARGIN: f64 = 3.0;
/// Logarithm of a prior probability below which the best hypothesis is a question: so many changes may fit by chance.
pub(super) const UNLIKELY: f64 = -5.0;
/// Logarithm of the prior probability that a coordinate or the angle of the clamp is reversed.
const REVERSED: f64 = -3.5;
/// Logarithm of the prior probability that the sensor is turned about z by no multiple of 90 degrees.
const OBLIQUE: f64 = -4.0;
/// Angles of such a turn that are tried, degrees: multiples of the first up to the second. A smaller angle is an error of the clamp's angle.
const OBLIQUE_ANGLES: (i32, i32) = (10, 40);
/// Logarithm of the prior probability that x and y are in different units although the file states none: less than that of a reversed coordinate.
const MIXED: f64 = -4.0;
/// Logarithm of the prior probability of another unit below which the file or the user states the unit: x and y are then as stated.
const STATED: f64 = -6.0;
/// Logarithm of the probability that a hypothesis is right that does not explain the recording: more than a file's word for a unit is worth.
const MISFIT: f64 = -10.0;
/// Standard deviation of the logarithm of a rod's stiffness, as far as its file knows it.
const STIFFNESS: f64 = 0.3;
/// Standard deviation of the logarithm of the farthest contact, in lengths of the rod: in units in which forces are k^2, moments k and ways 1/k
/// times as large, tangential contacts satisfy all conditions, but are at 1/k of the place.
const REACH: f64 = 1.0;
/// A recording all of whose contacts are nearer to the clamp than this, in lengths of the rod, is in other units, or of another rod.
const NEAREST: f64 = 0.1;
/// The unit may be another one where the slope of the line is within this factor of that of the rod in that unit.
pub(super) const NEAR: f64 = 2.0;
/// The same for the largest m0z^2 / (2 |F|), which has more scatter.
const LOOSE: std::ops::Range<f64> = 0.05..4.0;
/// Most other hypotheses that are reported.
const OTHERS: usize = 3;

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

    pub fn of(self, Reactions { f0x, f0y, m0z }: Reactions) -> Reactions {
        let [x, y, z] = self.turned.map(|turned| if turned { -1.0 } else { 1.0 });
        let (f0x, f0y) = if self.swapped { (f0y, f0x) } else { (f0x, f0y) };
        Reactions { f0x: x * f0x, f0y: y * f0y, m0z: z * m0z }
    }

    fn samples(self, samples: &[Sample]) -> Vec<Sample> {
        samples.iter().map(|sample| Sample { reactions: self.of(sample.reactions), ..*sample }).collect()
    }

    /// Logarithm of the prior probability, of those of loads, of a turn and of a mirror.
    fn prior(self, [load, turn, mirror]: [f64; 3]) -> f64 {
        let [x, y, z] = self.turned;
        // the moment has the sign of the plane's orientation, and both have that of the sense
        let is_mirrored = self.swapped != (x != y);
        let sense = if z == is_mirrored { 0.0 } else { load };
        match (is_mirrored, self.is_as_is() || self.is_load()) {
            (_, true) => sense,
            (true, _) => mirror + sense,
            (false, _) => turn + sense,
        }
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

/// Units of lengths, angles, forces and moments; see [`Candidate`].
pub(super) const DIMENSIONS: usize = 4;

/// A unit in which columns may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Candidate {
    pub unit: &'static str,
    /// One of it, relative to the unit in which the samples are.
    pub factor: f64,
    /// Logarithm of the prior probability, relative to that of others.
    pub prior: f64,
}

/// Axes, signs and units of all columns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Hypothesis {
    pub frame: ReactionFrame,
    /// Whether x, y and the angle of the clamp are reversed.
    pub reversed: [bool; 3],
    /// The units, as indices of the candidates.
    pub units: [usize; DIMENSIONS],
}

/// A hypothesis with how well it explains the samples.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rated {
    pub hypothesis: Hypothesis,
    /// Share of the averages that satisfy one of the two conditions.
    pub explained: f64,
    /// Share that some single contact explains.
    pub possible: f64,
    /// The farthest contact, in lengths of the rod.
    pub reach: f64,
    /// Concordance of the work of the clamp and the change of the energy.
    pub energy: f64,
    /// Bending stiffness of the line over that of the rod, in these units; 1 without either.
    pub stiffness: f64,
    /// Logarithm of the prior probability.
    pub prior: f64,
}

impl Rated {
    /// Logarithm of the posterior probability, but for a constant.
    pub fn score(&self) -> f64 {
        let sizes = 0.5 * (self.stiffness.ln() / STIFFNESS).powi(2) + 0.5 * (self.reach.ln() / REACH).powi(2);
        let misfit = if self.fits() { 0.0 } else { MISFIT };
        INDEPENDENT * (self.explained + self.possible + self.energy) + self.prior - sizes + misfit
    }

    /// Whether it explains the recording at all.
    pub fn fits(&self) -> bool {
        let is_explained = self.explained >= SHARE && self.energy >= WEAK_WORK;
        let is_by_work = self.explained >= FEW && self.energy >= WORK;
        (is_explained || is_by_work) && self.reach > NEAREST
    }
}

/// The hypotheses that the physics prefers.
#[derive(Clone, Debug)]
pub(super) struct Verdict {
    pub best: Rated,
    /// Others with another frame or pose, the most probable first.
    pub others: Vec<Rated>,
    /// Whether axes and signs can be relied on.
    pub is_decided: bool,
    /// Whether the units can.
    pub are_units_decided: [bool; DIMENSIONS],
    /// The angle about z, degrees, counter-clockwise, by which the forces have to be turned to fit about as well or better than as they are.
    pub oblique: Option<f64>,
    /// Means of the reactions over the first samples, where these are steady and not 0: an offset, which was subtracted.
    pub offset: Option<[f64; 3]>,
}

/// What is known before.
#[derive(Clone, Debug)]
pub(super) struct Before<'r> {
    pub rod: Option<&'r Rod>,
    /// Units that may be; the first are those of the samples.
    pub units: [Vec<Candidate>; DIMENSIONS],
    /// Logarithms of the prior probabilities of loads, of a sensor turned by quarter turns, and of one that is mirrored (upside down).
    pub frames: [f64; 3],
}

/// The most probable hypotheses; none where too few samples are in contact.
pub(super) fn verdict(samples: &[Sample], before: &Before<'_>) -> Option<Verdict> {
    let (averages, noise, offset) = averages(samples)?;
    let mut rated = Vec::new();
    for angle in 0..before.units[1].len() {
        rate(&averages, noise, angle, before, &mut rated);
    }
    rated.sort_by(|a, b| b.score().total_cmp(&a.score()));
    let best = *rated.first()?;
    if let Some(rod) = before.rod
        && !best.fits()
    {
        // in units that the rod contradicts the recording may still agree with itself
        let alone = verdict(samples, &Before { rod: None, ..before.clone() });
        if let Some(mut alone) = alone.filter(|alone| alone.best.fits()) {
            let Hypothesis { frame, units, .. } = alone.best.hypothesis;
            let one = |of: usize| before.units[of][units[of]].factor;
            let slope = slope(&frame.samples(&turned(&averages, one(1))))?;
            alone.best.stiffness = slope * one(3).powi(2) / one(2) / rod.bending_stiffness();
            return Some(alone);
        }
    }
    let lead = |differs: &dyn Fn(&Hypothesis) -> bool| {
        let other = rated.iter().find(|other| differs(&other.hypothesis));
        best.fits() && other.is_none_or(|other| best.score() - other.score() >= MARGIN)
    };
    let Hypothesis { frame, reversed, units } = best.hypothesis;
    let differs = |other: &Hypothesis| (other.frame, other.reversed) != (frame, reversed);
    let is_decided = lead(&differs);
    let mut are_units_decided = [0, 1, 2, 3].map(|of: usize| lead(&|other| other.units[of] != units[of]));
    let of_one = INDEPENDENT * best.energy + before.units[0][units[0]].prior;
    let is_mixed =
        mixed_lengths(&averages, noise, &best.hypothesis, before).is_some_and(|mixed| of_one - mixed < MARGIN);
    are_units_decided[0] &= !is_mixed;
    let mut others: Vec<Rated> = Vec::new();
    for other in rated.iter().filter(|other| differs(&other.hypothesis)) {
        let is_new = others.iter().all(|known| {
            (known.hypothesis.frame, known.hypothesis.reversed) != (other.hypothesis.frame, other.hypothesis.reversed)
        });
        if is_new && others.len() < OTHERS {
            others.push(*other);
        }
    }
    let oblique = if is_decided { oblique(&averages, noise, &best, before) } else { None };
    Some(Verdict { best, others, is_decided, are_units_decided, oblique, offset })
}

/// The angle by which forces turned about z explain the samples as well as the best hypothesis, its smaller prior probability included, or better;
/// none if all are less probable.
fn oblique(averages: &[Sample], noise: [f64; 3], best: &Rated, before: &Before<'_>) -> Option<f64> {
    let Hypothesis { frame, reversed: [x, y, phi], units: [length, angle, force, moment] } = best.hypothesis;
    // as in `Shared::hypotheses`: a reversed angle is a mirrored frame
    let [a, b, c] = frame.turned;
    let (frame, y) = if phi { (ReactionFrame { turned: [a, !b, !c], ..frame }, !y) } else { (frame, y) };
    let plain = frame.samples(&turned(averages, before.units[1][angle].factor));
    let sign = |turned: bool| if turned { -1.0 } else { 1.0 };
    let one = match before.rod {
        Some(_) => [1.0; 2],
        None => [before.units[2][force].factor, before.units[3][moment].factor],
    };
    let way = one[0] * before.units[0][length].factor;
    let (step, most) = OBLIQUE_ANGLES;
    let angles = (1..=most / step).flat_map(|k| [k * step, -k * step]).map(f64::from);
    let rated = angles.filter_map(|degrees| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let rotated = |sample: &Sample| {
            let Reactions { f0x, f0y, m0z } = sample.reactions;
            let reactions = Reactions { f0x: cos * f0x - sin * f0y, f0y: sin * f0x + cos * f0y, m0z };
            Sample { reactions, ..*sample }
        };
        let samples: Vec<Sample> = plain.iter().map(rotated).collect();
        let slope = slope(&samples).filter(|slope| *slope > 0.0);
        let found = agreements(&samples, ReactionFrame::AS_IS, noise, slope, before);
        let (_, agreement, stiffness) = found.into_iter().find(|one| one.0 == [force, moment])?;
        let energy = agreement.concordance([sign(x) * way, sign(y) * way, one[1], one[1]]);
        let Agreement { explained, possible, reach, .. } = agreement;
        let prior = best.prior + OBLIQUE;
        Some((degrees, Rated { explained, possible, reach, energy, stiffness, prior, ..*best }.score()))
    });
    let (degrees, score) = rated.max_by(|a, b| a.1.total_cmp(&b.1))?;
    (score > best.score()).then_some(degrees)
}

/// The work's and the prior's part of the score if x and y are in different units; none where one of them stays the same, or their units are stated.
fn mixed_lengths(averages: &[Sample], noise: [f64; 3], best: &Hypothesis, before: &Before<'_>) -> Option<f64> {
    let lengths = &before.units[0];
    let moves = |of: fn(&Sample) -> f64| averages.iter().any(|sample| of(sample) != of(&averages[0]));
    let is_open = lengths.iter().skip(1).any(|candidate| candidate.prior > STATED);
    if !(is_open && moves(|sample| sample.pose.x) && moves(|sample| sample.pose.y)) {
        return None;
    }
    let [_, angle, force, moment] = best.units;
    let [x, y, phi] = best.reversed;
    // as in `Shared::hypotheses`: a reversed angle is a mirrored frame
    let [a, b, c] = best.frame.turned;
    let (frame, y) = if phi { (ReactionFrame { turned: [a, !b, !c], ..best.frame }, !y) } else { (best.frame, y) };
    let samples = frame.samples(&turned(averages, before.units[1][angle].factor));
    let slope = slope(&samples).filter(|slope| *slope > 0.0);
    let found = agreements(&samples, frame, noise, slope, before);
    let agreement = found.into_iter().find(|one| one.0 == [force, moment])?.1;
    let one = match before.rod {
        Some(_) => [1.0; 2],
        None => [before.units[2][force].factor, before.units[3][moment].factor],
    };
    let sign = |turned: bool| if turned { -1.0 } else { 1.0 };
    let pairs = lengths.iter().flat_map(|a| lengths.iter().map(move |b| (a, b))).filter(|(a, b)| a.factor != b.factor);
    let rated = pairs.map(|(a, b)| {
        let factors = [sign(x) * one[0] * a.factor, sign(y) * one[0] * b.factor, one[1], one[1]];
        INDEPENDENT * agreement.concordance(factors) + a.prior.min(b.prior) + MIXED
    });
    rated.max_by(f64::total_cmp)
}

/// Samples whose angles are in another unit.
fn turned(samples: &[Sample], factor: f64) -> Vec<Sample> {
    let of = |sample: &Sample| {
        let mut sample = *sample;
        sample.pose.phi *= factor;
        sample
    };
    samples.iter().map(of).collect()
}

/// Means of consecutive samples less the offset, the standard deviations of the reactions in them, and the offset, if there is one.
pub(super) type Averages = (Vec<Sample>, [f64; 3], Option<[f64; 3]>);

pub(super) fn averages(samples: &[Sample]) -> Option<Averages> {
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
pub(super) fn slope(samples: &[Sample]) -> Option<f64> {
    Some(plausibility(&Rod::new(1.0, 1.0).ok()?, samples).line?.slope)
}

/// Rates all hypotheses in which the angles are in this unit.
fn rate(averages: &[Sample], noise: [f64; 3], angle: usize, before: &Before<'_>, rated: &mut Vec<Rated>) {
    let averages = turned(averages, before.units[1][angle].factor);
    // the line depends on the order and the relative sign of the forces; the slope changes its sign with both
    let lines = [false, true].map(|swapped| {
        [false, true]
            .map(|opposite| slope(&ReactionFrame { swapped, turned: [false, opposite, false] }.samples(&averages)))
    });
    let moves = |of: fn(&Sample) -> f64| averages.iter().any(|sample| of(sample) != of(&averages[0]));
    let may_be_reversed = [
        moves(|sample| sample.pose.x),
        moves(|sample| sample.pose.y),
        averages.iter().any(|sample| sample.pose.phi != 0.0),
    ];
    for frame in ReactionFrame::all() {
        let [x, y, _] = frame.turned;
        let slope = lines[usize::from(frame.swapped)][usize::from(x != y)].map(|slope| if x { -slope } else { slope });
        let slope = slope.filter(|slope| *slope > 0.0);
        let samples = frame.samples(&averages);
        for (units, agreement, stiffness) in agreements(&samples, frame, noise, slope, before) {
            let shared = Shared { frame, angle, units, stiffness, may_be_reversed, agreement: &agreement };
            shared.hypotheses(before, rated);
        }
    }
}

/// The agreement of samples in each pair of units of forces and moments that the rod allows, and the stiffness of the line over that of
/// the rod. Without a rod all pairs agree alike.
fn agreements(
    samples: &[Sample],
    frame: ReactionFrame,
    noise: [f64; 3],
    slope: Option<f64>,
    before: &Before<'_>,
) -> Vec<([usize; 2], Agreement, f64)> {
    let [.., forces, moments] = &before.units;
    let across = if frame.swapped { [noise[1], noise[0], noise[2]] } else { noise };
    let noise = [across[0].max(across[1]), across[2]];
    let pairs = (0..forces.len()).flat_map(|force| (0..moments.len()).map(move |moment| [force, moment]));
    let Some(rod) = before.rod else {
        let found = slope.and_then(|slope| agreement(samples, noise, slope, None));
        return found.map_or_else(Vec::new, |found| pairs.map(|pair| (pair, found.clone(), 1.0)).collect());
    };
    let ratio = slope.unwrap_or_else(|| largest_criterion(samples)) / rod.bending_stiffness();
    let range = if slope.is_some() { 1.0 / NEAR..NEAR } else { LOOSE };
    let in_units = |[force, moment]: [usize; 2]| {
        let (force_unit, moment_unit) = (forces[force].factor, moments[moment].factor);
        let ratio = ratio * moment_unit.powi(2) / force_unit;
        if !range.contains(&ratio) {
            return None;
        }
        let stiffness = if slope.is_some() { ratio } else { 1.0 };
        let scaled = |sample: &Sample| {
            let Reactions { f0x, f0y, m0z } = sample.reactions;
            let reactions = Reactions { f0x: force_unit * f0x, f0y: force_unit * f0y, m0z: moment_unit * m0z };
            Sample { reactions, ..*sample }
        };
        let samples: Vec<Sample> = samples.iter().map(scaled).collect();
        let noise = [force_unit * noise[0], moment_unit * noise[1]];
        let found = agreement(&samples, noise, rod.bending_stiffness() * stiffness, Some(rod.length()))?;
        Some(([force, moment], found, stiffness))
    };
    pairs.filter_map(in_units).collect()
}

/// The largest m0z^2 / (2 |F|) but for a twentieth: at most the stiffness, and not much less.
fn largest_criterion(samples: &[Sample]) -> f64 {
    let of = |sample: &Sample| {
        let Reactions { f0x, f0y, m0z } = sample.reactions;
        m0z * m0z / (2.0 * f0x.hypot(f0y))
    };
    let largest = samples.iter().map(|s| s.reactions.f0x.hypot(s.reactions.f0y)).fold(0.0, f64::max);
    let strong = samples.iter().filter(|s| s.reactions.f0x.hypot(s.reactions.f0y) > 0.1 * largest);
    let mut all: Vec<f64> = strong.map(of).filter(|value| value.is_finite()).collect();
    all.sort_unstable_by(f64::total_cmp);
    all.get(all.len() * 19 / 20).copied().unwrap_or_default()
}

/// Hypotheses with the same contacts: the work alone distinguishes them.
struct Shared<'a> {
    frame: ReactionFrame,
    angle: usize,
    units: [usize; 2],
    stiffness: f64,
    may_be_reversed: [bool; 3],
    agreement: &'a Agreement,
}

impl Shared<'_> {
    fn hypotheses(&self, before: &Before<'_>, rated: &mut Vec<Rated>) {
        let [lengths, angles, forces, moments] = &before.units;
        let [force, moment] = self.units;
        // with a rod the agreement is in these units already
        let one = if before.rod.is_some() { [1.0; 2] } else { [forces[force].factor, moments[moment].factor] };
        let units_prior = angles[self.angle].prior + forces[force].prior + moments[moment].prior;
        let either = |may: bool| if may { &[false, true][..] } else { &[false] };
        for (length, candidate) in lengths.iter().enumerate() {
            for (&x, &y) in either(self.may_be_reversed[0])
                .iter()
                .flat_map(|x| either(self.may_be_reversed[1]).iter().map(move |y| (x, y)))
            {
                let sign = |turned: bool| if turned { -1.0 } else { 1.0 };
                let way = one[0] * candidate.factor;
                let energy = self.agreement.concordance([sign(x) * way, sign(y) * way, one[1], one[1]]);
                for &phi in either(self.may_be_reversed[2]) {
                    // a rod mirrored about x, with f0y and m0z, has the same contacts at the opposite angle; its work along y is the opposite
                    let [a, b, c] = self.frame.turned;
                    let frame = if phi { ReactionFrame { turned: [a, !b, !c], ..self.frame } } else { self.frame };
                    let reversed = [x, y != (phi && self.may_be_reversed[1]), phi];
                    let prior = units_prior
                        + candidate.prior
                        + frame.prior(before.frames)
                        + REVERSED * reversed.iter().filter(|reversed| **reversed).count() as f64;
                    rated.push(Rated {
                        hypothesis: Hypothesis { frame, reversed, units: [length, self.angle, force, moment] },
                        explained: self.agreement.explained,
                        possible: self.agreement.possible,
                        reach: self.agreement.reach,
                        energy,
                        stiffness: self.stiffness,
                        prior,
                    });
                }
            }
        }
    }
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
            let Some(verdict) = verdict(&file, &before(rod, [0.0; 3], &[1.0], &[1.0])) else { return false };
            let best = verdict.best.hypothesis;
            assert!(!verdict.is_decided || best.frame == told && best.reversed == [false; 3], "{told:?}: {verdict:?}");
            verdict.is_decided
        };
        ReactionFrame::all().step_by(5).filter(|frame| is_right(*frame)).count()
    }

    /// Lengths in m, mm, cm or inches, angles in rad, and these units of forces and moments.
    fn before<'r>(rod: Option<&'r Rod>, frames: [f64; 3], forces: &[f64], moments: &[f64]) -> Before<'r> {
        let units = |factors: &[f64]| {
            factors.iter().map(|factor| Candidate { unit: "", factor: *factor, prior: 0.0 }).collect::<Vec<_>>()
        };
        let units = [units(&[1.0, 1e-3, 1e-2, 0.0254]), units(&[1.0]), units(forces), units(moments)];
        Before { rod, units, frames }
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
            // with friction no line gives the stiffness
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
            let before = before(Some(&rod), [0.0; 3], &[1.0, 1e-3], &[1.0, 1e-3, 1e-6]);
            let verdict = verdict(&file, &before).unwrap();
            let best = verdict.best.hypothesis;
            assert!(verdict.is_decided && best.frame.is_as_is(), "{verdict:?}");
            let found = [2, 3].map(|of: usize| before.units[of][best.units[of]].factor);
            assert!(verdict.are_units_decided == [true; 4] && found == [force, moment], "{verdict:?}");
        }
    }

    /// A coordinate that is reversed is another hypothesis than forces and moments that are.
    #[test]
    fn a_reversed_coordinate_is_not_taken_for_reversed_reactions() {
        let rod = Rod::new(0.1, 6.32e-4).unwrap();
        let mut samples = scan(0.0, NoiseModel::default());
        samples.iter_mut().for_each(|sample| sample.pose.x *= -1.0);
        let verdict = verdict(&samples, &before(Some(&rod), [-2.3, -2.0, -5.0], &[1.0], &[1.0])).unwrap();
        assert!(!verdict.is_decided && verdict.best.hypothesis.reversed == [true, false, false], "{verdict:?}");
        assert_eq!(verdict.others[0].hypothesis.frame.turned, [true, false, true], "{verdict:?}");
    }
}
