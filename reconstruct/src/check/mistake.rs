//! Mistakes in a recording that can be undone.

use super::findings::{LONG_WAY, NEAR};
use crate::numeric::CHANCE;
use rod_core::{Pose, Reactions, Rod, Sample};
use std::f64::consts::{PI, TAU};
use std::fmt;

/// Share of a recording, and least number of samples, at its begin in which the reactions are those without load if they stay the same there.
const AT_REST: f64 = 0.03;
const FEWEST: usize = 8;
/// Range of a coordinate, rod lengths, below which it is constant but for trembling: its sign cannot be told from the recording.
const MOVES: f64 = 0.01;

/// A mistake in signs, axes or units of a recording, or in the rod, that can be undone.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Mistake {
    /// Which of f0x, f0y, m0z have the wrong sign.
    Signs([bool; 3]),
    /// f0x and f0y are each other.
    Swapped,
    /// x0 runs the other way.
    MirroredX,
    /// y0 runs the other way.
    MirroredY,
    /// phi0 points the other way.
    Turned,
    /// phi0 counts clockwise.
    Clockwise,
    /// phi0 is in degrees.
    Degrees,
    /// x0 and y0 are in mm.
    Millimetres,
    /// Forces and moments are in other units: one of them is so many N and so many N m.
    Units(f64, f64),
    /// Forces and moments are so many times what they should be.
    Gains(f64, f64),
    /// The bending stiffness is another one, N m^2.
    Stiffness(f64),
    /// The sensor is not tared: without load it shows these reactions.
    Tare(Reactions),
}

impl Mistake {
    /// All mistakes that are of signs, axes and units.
    pub(crate) const ALL: [Self; 17] = [
        Self::Signs([true, false, false]),
        Self::Signs([false, true, false]),
        Self::Signs([false, false, true]),
        Self::Signs([true, true, false]),
        Self::Signs([true, false, true]),
        Self::Signs([false, true, true]),
        Self::Signs([true, true, true]),
        Self::Swapped,
        Self::MirroredX,
        Self::MirroredY,
        Self::Turned,
        Self::Clockwise,
        Self::Degrees,
        Self::Millimetres,
        Self::Units(1e-3, 1.0),
        Self::Units(1.0, 1e-3),
        Self::Units(1e-3, 1e-3),
    ];

    /// Whether a recording with these samples can contain it: a coordinate that does not change shows no direction, and millimetres that
    /// are taken for metres are a long way.
    pub(crate) fn is_possible(self, rod: &Rod, samples: &[Sample]) -> bool {
        let changes = |of: fn(&Pose) -> f64| {
            let values = || samples.iter().map(|sample| of(&sample.pose));
            let (least, most) = (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
            most - least > MOVES * rod.length()
        };
        match self {
            Self::MirroredX => changes(|pose| pose.x),
            Self::MirroredY => changes(|pose| pose.y),
            // angles within a turn are taken for radians, as by the check
            Self::Millimetres => [|pose: &Pose| pose.x, |pose: &Pose| pose.y].into_iter().any(|of| {
                let values = || samples.iter().map(|sample| of(&sample.pose));
                let (least, most) =
                    (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
                most - least > LONG_WAY * rod.length()
            }),
            Self::Degrees => samples.iter().any(|sample| sample.pose.phi.abs() > TAU),
            _ => true,
        }
    }

    /// The sensor is not tared, if the reactions stay the same at the begin of a recording.
    pub(crate) fn of_rest(samples: &[Sample]) -> Option<Self> {
        let count = ((AT_REST * samples.len() as f64) as usize).max(2 * FEWEST);
        let three = |sample: &Sample| [sample.reactions.f0x, sample.reactions.f0y, sample.reactions.m0z];
        let rest: Vec<[f64; 3]> = samples.get(..count)?.iter().map(three).collect();
        let (first, second) = rest.split_at(count / 2);
        let mean = |part: &[[f64; 3]], c: usize| part.iter().map(|r| r[c]).sum::<f64>() / part.len() as f64;
        let variance = |part: &[[f64; 3]], c: usize| {
            let centre = mean(part, c);
            part.iter().map(|r| (r[c] - centre).powi(2)).sum::<f64>() / part.len() as f64
        };
        let is_steady = |c: usize| {
            let error = ((variance(first, c) + variance(second, c)) / (count / 2) as f64).sqrt();
            (mean(second, c) - mean(first, c)).abs() <= CHANCE * error
        };
        let [f0x, f0y, m0z] = [0, 1, 2].map(|c| mean(&rest, c));
        (0..3).all(is_steady).then_some(Self::Tare(Reactions { f0x, f0y, m0z }))
    }

    /// Whether what the sensor shows at rest is more than three standard deviations of its `bias`: less is an error that all samples share.
    pub(crate) fn is_beyond(self, bias: [f64; 3]) -> bool {
        let Self::Tare(Reactions { f0x, f0y, m0z }) = self else { return true };
        [f0x, f0y, m0z].into_iter().zip(bias).any(|(shown, sigma)| shown.abs() > 3.0 * sigma)
    }

    /// Whether the line of tangential contacts, whose slope is the bending stiffness, has about that of the rod without the mistake. Without a line nothing
    /// tells of units: a recording in units that are too small by far is all noise.
    pub(crate) fn leaves_line(self, rod: &Rod, slope: Option<f64>) -> bool {
        let (Self::Units(force, moment), Some(slope)) = (self, slope) else { return !matches!(self, Self::Units(..)) };
        let ratio = slope.abs() / rod.bending_stiffness() * moment * moment / force;
        ratio.log10().abs() < NEAR.log10()
    }

    /// What a slope of m0z^2 over 2 (f0y sin phi0 + f0x cos phi0) may come from that suggests another bending stiffness than the given one.
    pub(crate) fn of_slope(given: f64, suggested: f64) -> [Self; 3] {
        let ratio = suggested / given;
        [Self::Stiffness(suggested), Self::Gains(1.0, ratio.sqrt()), Self::Gains(1.0 / ratio, 1.0)]
    }

    /// The rod and the samples without it.
    pub(crate) fn undone(self, rod: &Rod, samples: &[Sample]) -> (Rod, Vec<Sample>) {
        let pose = |pose: Pose| match self {
            Self::MirroredX => Pose { x: -pose.x, ..pose },
            Self::MirroredY => Pose { y: -pose.y, ..pose },
            Self::Turned => Pose { phi: pose.phi + PI, ..pose },
            Self::Clockwise => Pose { phi: -pose.phi, ..pose },
            Self::Degrees => Pose { phi: pose.phi.to_radians(), ..pose },
            Self::Millimetres => Pose { x: 1e-3 * pose.x, y: 1e-3 * pose.y, ..pose },
            _ => pose,
        };
        let reactions = |Reactions { f0x, f0y, m0z }: Reactions| match self {
            Self::Signs(wrong) => {
                let [x, y, z] = wrong.map(|wrong| if wrong { -1.0 } else { 1.0 });
                Reactions { f0x: x * f0x, f0y: y * f0y, m0z: z * m0z }
            }
            Self::Gains(force, moment) => Reactions { f0x: f0x / force, f0y: f0y / force, m0z: m0z / moment },
            Self::Tare(rest) => Reactions { f0x: f0x - rest.f0x, f0y: f0y - rest.f0y, m0z: m0z - rest.m0z },
            Self::Swapped => Reactions { f0x: f0y, f0y: f0x, m0z },
            Self::Units(force, moment) => Reactions { f0x: force * f0x, f0y: force * f0y, m0z: moment * m0z },
            _ => Reactions { f0x, f0y, m0z },
        };
        // standard deviations have no sign
        let sigma =
            |sigma: Reactions| if matches!(self, Self::Signs(_) | Self::Tare(_)) { sigma } else { reactions(sigma) };
        let undone = |sample: &Sample| Sample {
            t: sample.t,
            pose: pose(sample.pose),
            reactions: reactions(sample.reactions),
            sigma: sample.sigma.map(sigma),
        };
        let other = if let Self::Stiffness(value) = self { Rod::new(rod.length(), value).ok() } else { None };
        (other.unwrap_or(*rod), samples.iter().map(undone).collect())
    }
}

impl fmt::Display for Mistake {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Signs(wrong) => {
                let names = ["f0x", "f0y", "m0z"].into_iter().zip(wrong).filter(|one| one.1).map(|one| one.0);
                let names: Vec<&str> = names.collect();
                let verb = if names.len() == 1 { "has" } else { "have" };
                write!(f, "{} {verb} the wrong sign", names.join(" and "))
            }
            Self::Swapped => f.write_str("f0x and f0y are swapped"),
            Self::MirroredX => f.write_str("x0 runs the other way"),
            Self::MirroredY => f.write_str("y0 runs the other way"),
            Self::Turned => f.write_str("phi0 points the other way"),
            Self::Clockwise => f.write_str("phi0 counts clockwise"),
            Self::Degrees => f.write_str("phi0 is in degrees"),
            Self::Millimetres => f.write_str("x0, y0 are in mm"),
            Self::Units(force, moment) => match (force < 1.0, moment < 1.0) {
                (true, false) => f.write_str("forces are in mN"),
                (false, _) => f.write_str("moments are in N mm (or mN m)"),
                (true, true) => f.write_str("forces are in mN and moments in N mm (or mN m)"),
            },
            Self::Gains(1.0, moment) => write!(f, "m0z is {moment:.3} times the true value"),
            Self::Gains(force, _) => write!(f, "f0x and f0y are {force:.3} times the true value"),
            Self::Tare(Reactions { f0x, f0y, m0z }) => write!(
                f,
                "the sensor is not tared: at the begin of the recording it shows {f0x:.3e} N, {f0y:.3e} N and {m0z:.3e} N m; subtract them"
            ),
            Self::Stiffness(value) => write!(f, "the bending stiffness is {value:.4e} N m^2"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_undone_twice_is_as_it_was() {
        let rod = Rod::new(0.1, 6.3e-4).unwrap();
        let pose = Pose { x: 0.01, y: -0.04, phi: 1.5 };
        let sample = Sample::new(pose, Reactions { f0x: 0.01, f0y: -0.02, m0z: 3e-4 });
        let turns = [Mistake::MirroredX, Mistake::MirroredY, Mistake::Clockwise, Mistake::Swapped];
        for mistake in Mistake::ALL[..7].iter().chain(&turns) {
            let once = mistake.undone(&rod, &[sample]).1;
            assert_ne!(once, [sample], "{mistake}");
            assert_eq!(mistake.undone(&rod, &once).1, [sample], "{mistake}");
        }
        assert!(!Mistake::MirroredX.is_possible(&rod, &[sample, sample]));
    }

    #[test]
    fn units_and_tare_agree_with_line_and_rest() {
        let rod = Rod::new(0.1, 6.3e-4).unwrap();
        let leaves = |slope: f64| Mistake::ALL.iter().filter(|one| one.leaves_line(&rod, Some(slope))).count();
        // signs and axes do not change the line
        assert_eq!([6.0e-4, 0.6, 600.0].map(leaves), [14, 15, 15]);
        let at = |f0x: f64| Sample::new(Pose { x: 0.0, y: 0.0, phi: 1.5 }, Reactions { f0x, f0y: 0.2, m0z: 0.0 });
        let steady: Vec<Sample> = (0..16).map(|k| at(0.1 + 1e-3 * f64::from(k % 2))).collect();
        let Some(Mistake::Tare(rest)) = Mistake::of_rest(&steady) else { panic!("not at rest") };
        assert!((rest.f0x - 0.1005).abs() < 1e-12 && (rest.f0y - 0.2).abs() < 1e-12);
        assert!(Mistake::Tare(rest).undone(&rod, &[at(0.1)]).1[0].reactions.f0y.abs() < 1e-12);
        assert!(Mistake::Tare(rest).is_beyond([5e-3; 3]) && !Mistake::Tare(rest).is_beyond([0.1; 3]));
        let rising: Vec<Sample> = (0..16).map(|k| at(0.01 * f64::from(k))).collect();
        assert_eq!(Mistake::of_rest(&rising), None);
    }
}
