//! A conclusion of the check by the physics.

use super::shares::Shares;
use crate::phase::{Basis, Label};
use crate::systematic::Source;
use std::fmt;

/// Relative difference of the length from which on the recording does not fit the rod. Larger than that of the stiffness: samples with
/// several contacts may look like contacts of the tip at another length.
const MISFIT_LENGTH: f64 = 0.2;
/// Intercept, relative to the largest m0z^2, or offset of the moment, relative to the largest moment, from which on the recording does
/// not fit the rod.
const MISFIT_SHIFT: f64 = 0.02;

/// Relative difference of the stiffness from which on it is another rod.
const GROSS_STIFFNESS: f64 = 0.3;
/// Angle of the clamp, radians, from which on it must be in degrees.
const MISFIT_ANGLE: f64 = 20.0;
/// Way of the clamp, rod lengths, from which on it must be in another unit.
const MISFIT_WAY: f64 = 200.0;

/// Units by the power of ten that they give the slope.
pub(super) const UNITS: [(i32, &str); 8] = [
    (-6, "forces are in uN, or moments in kN mm or N km"),
    (-3, "forces are in mN"),
    (3, "moments are in N mm and forces in mN"),
    (4, "moments are in N cm"),
    (6, "moments are in N mm (or mN m)"),
    (8, "moments are in mN cm and forces in N"),
    (9, "moments are in mN mm and forces in mN"),
    (12, "moments are in mN mm"),
];

/// Share of wrong labels to be expected from which on the labels are no answer.
const MISFIT_LABELS: f64 = 0.05;
/// The same of samples of a sensor that is stuck.
const MISFIT_FROZEN: f64 = 0.1;

/// A conclusion of the check by the physics. Displays as a sentence without its full stop.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Finding {
    /// The rod is always free.
    NoContact,
    /// The samples of tangential contacts are on no line.
    NoLine,
    /// The slope is negative.
    Sign,
    /// The slope is about the stiffness times a power of ten.
    Units {
        /// Slope over bending stiffness.
        ratio: f64,
        /// The power.
        power: i32,
    },
    /// The slope is that of another stiffness.
    Stiffness {
        /// That of the rod, N m^2.
        given: f64,
        /// That of the recording, N m^2, in the units that it seems to be in.
        suggested: f64,
        /// Its standard error, N m^2.
        sigma: f64,
    },
    /// The line does not go through the origin.
    Intercept {
        /// The intercept, in parts of the largest m0z^2.
        part: f64,
        /// The force to be subtracted from the load f0y sin phi0 + f0x cos phi0, N.
        force: f64,
    },
    /// The moment has an offset.
    MomentOffset {
        /// The offset, N m.
        moment: f64,
        /// Its standard error, N m.
        sigma: f64,
        /// In parts of the largest moment.
        part: f64,
    },
    /// The moment has the wrong sign.
    MomentSign,
    /// Contacts of the tip are all at another arc length than the rod's.
    Length {
        /// That of the rod, m.
        given: f64,
        /// That of the recording, m.
        suggested: f64,
    },
    /// The angle of the clamp exceeds a turn.
    Angle {
        /// The largest, radians.
        largest: f64,
    },
    /// The path of the clamp is very long.
    Way {
        /// In lengths of the rod.
        lengths: f64,
    },
    /// There is friction that was not asked for.
    Friction {
        /// Its coefficient, negative where the rod is pushed on.
        mu: f64,
        /// Its standard deviation.
        sigma: f64,
        /// Logarithm of the likelihood of the scan with friction over that without.
        gain: f64,
    },
    /// The coefficient of friction that was given is not that of the scan.
    FrictionGiven {
        /// The one given, negative where the rod is pushed on.
        given: f64,
        /// That of the scan.
        mu: f64,
        /// Its standard deviation.
        sigma: f64,
        /// How far they are apart, in standard deviations of both.
        deviation: f64,
    },
    /// K / (2 |F|) along tangential contacts has not one value: friction changes along the scan, or contacts stick.
    FrictionChanges {
        /// The coefficient that was used.
        mu: f64,
        /// How far the values are from one, in standard deviations of the noise.
        scatter: f64,
        /// In terms of the coefficient.
        spread: f64,
    },
    /// The rod slides the other way than its friction asks for: what looks like friction is another error, or contacts stick.
    FrictionAgainst {
        /// The coefficient that was used.
        mu: f64,
        /// Share of the tangential path.
        share: f64,
    },
    /// No stretch of the scan is of a free rod, and nothing else tells the bias of the sensor.
    NoFreeStretch,
    /// The scan contradicts what is known of a source of error: the estimate is beyond three standard deviations of its budget.
    Budget {
        /// The source.
        of: Source,
        /// The estimate, in the unit of the source.
        value: f64,
        /// Its standard deviation.
        sigma: f64,
        /// The standard deviation that was known before.
        budget: f64,
    },
    /// After all corrections, a criterion along the contacts that it holds for departs from 0 by more than its noise.
    Misfit {
        /// Which.
        criterion: Basis,
        /// What is left of it, in parts of what the budget let it be.
        part: f64,
    },
    /// Many samples with a single contact have no contact point.
    Unanswered {
        /// Share of the samples with a single contact.
        share: f64,
    },
    /// A channel is given in steps that are larger than its noise and hide transitions.
    Coarse {
        /// f0x, f0y or m0z.
        channel: &'static str,
        /// The step, N or N m.
        step: f64,
    },
    /// Hardly any sample in contact has a contact point.
    Lost {
        /// Share of the samples in contact without one.
        share: f64,
    },
    /// The reactions of a noisy scan have kinks within the phase of one contact at the side of the rod.
    KinksWithin {
        /// How many.
        count: usize,
        /// The first sample after the first of them.
        from: usize,
    },
    /// Reactions stay exactly the same for many samples, which are left out.
    Frozen {
        /// Share of all samples.
        share: f64,
        /// The first of them.
        from: usize,
    },
    /// Many labels may be wrong.
    Uncertain {
        /// Share of wrong labels to be expected: the mean of 1 - probability.
        share: f64,
        /// The label of the run that is least sure.
        label: Label,
        /// Its first sample.
        from: usize,
        /// The first sample after it.
        to: usize,
        /// Whether one contour explains the recording: then it leaves them open, and there is no misfit.
        is_explained: bool,
    },
    /// No contact on this rod, with the stiffness of the line, explains a large part of the samples.
    Unexplained {
        /// The shares of what a single contact explains or not.
        shares: Shares,
        /// Whether these are shares of the samples on the line. Without a line they are of all samples in contact, of which some may have
        /// several contacts.
        tangential: bool,
    },
}

impl Finding {
    /// Whether units, signs or rod are so wrong that no small errors can be told from the recording.
    pub fn is_gross(&self) -> bool {
        match self {
            Self::Sign | Self::Units { .. } | Self::MomentSign => true,
            Self::Stiffness { given, suggested, .. } => (suggested / given - 1.0).abs() > GROSS_STIFFNESS,
            Self::Angle { .. } | Self::Way { .. } => self.is_misfit(),
            _ => false,
        }
    }

    /// Whether it is of the line of tangential contacts, or of what the stiffness by that line explains.
    pub fn is_of_line(&self) -> bool {
        matches!(
            self,
            Self::Sign
                | Self::Units { .. }
                | Self::MomentSign
                | Self::Stiffness { .. }
                | Self::Length { .. }
                | Self::Intercept { .. }
                | Self::MomentOffset { .. }
                | Self::Unexplained { .. }
        )
    }

    /// Whether a part of the result is missing or may be wrong, though recording, units and rod may fit together.
    pub fn is_warning(&self) -> bool {
        matches!(self, Self::Uncertain { .. } | Self::Frozen { .. } | Self::KinksWithin { .. })
    }

    /// Whether recording, units and rod do not fit together.
    pub fn is_misfit(&self) -> bool {
        match self {
            Self::NoContact | Self::NoLine | Self::KinksWithin { .. } => false,
            Self::Length { given, suggested } => (suggested / given - 1.0).abs() > MISFIT_LENGTH,
            Self::Intercept { part, .. } | Self::MomentOffset { part, .. } => part.abs() > MISFIT_SHIFT,
            Self::Unexplained { tangential, .. } => *tangential,
            // reported from 3 % and four standard errors on
            Self::Stiffness { .. }
            | Self::Sign
            | Self::Units { .. }
            | Self::MomentSign
            | Self::NoFreeStretch
            | Self::Friction { .. }
            | Self::FrictionGiven { .. }
            | Self::FrictionChanges { .. }
            | Self::FrictionAgainst { .. }
            | Self::Budget { .. } => true,
            Self::Misfit { .. } | Self::Unanswered { .. } | Self::Lost { .. } | Self::Coarse { .. } => true,
            Self::Uncertain { share, is_explained, .. } => !is_explained && *share > MISFIT_LABELS,
            Self::Frozen { share, .. } => *share > MISFIT_FROZEN,
            Self::Angle { largest } => *largest > MISFIT_ANGLE,
            Self::Way { lengths } => *lengths > MISFIT_WAY,
        }
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::NoContact => f.write_str("the rod has no contact in this recording, so that the physics cannot be checked"),
            Self::NoLine => f.write_str(
                "m0z^2 over 2 (f0y sin phi0 + f0x cos phi0) is not a straight line: too few tangential contacts, too \
                 much noise, or angles that are not in radians",
            ),
            Self::Sign => f.write_str(
                "the slope of m0z^2 over 2 (f0y sin phi0 + f0x cos phi0) is negative: f0x and f0y have the wrong sign (loads \
                 on the sensor instead of reactions of the clamp), or phi0 points the other way",
            ),
            Self::Units { ratio, power } => {
                let what = UNITS.iter().find(|unit| unit.0 == power).map_or("units are mixed up", |unit| unit.1);
                write!(
                    f,
                    "the slope of m0z^2 over 2 (f0y sin phi0 + f0x cos phi0) is {ratio:.3e} times the bending stiffness, \
                     as if {what}; expected N and N m"
                )
            }
            Self::Stiffness { given, suggested, sigma } => write!(
                f,
                "the bending stiffness is {given:.4e} N m^2, the recording gives {suggested:.4e} +- {sigma:.1e} N m^2"
            ),
            Self::Intercept { part, force } => write!(
                f,
                "m0z^2 over 2 (f0y sin phi0 + f0x cos phi0) misses the origin by {:.1} % of the largest m0z^2: the forces \
                 are not tared ({force:.3e} N too much), or the moments are about another point than the clamp",
                100.0 * part
            ),
            Self::MomentOffset { moment, sigma, part } => write!(
                f,
                "m0z is too large by {moment:.3e} +- {sigma:.1e} N m, {:.1} % of its largest value: it is not tared, or is about \
                 another point than the clamp",
                100.0 * part
            ),
            Self::MomentSign => f.write_str(
                "the moment bends the rod away from its contacts: m0z or f0x has the wrong sign, or the clamp points the other way",
            ),
            Self::Length { given, suggested } => write!(
                f,
                "the rod is {given:.5} m long, but contacts of its tip are {suggested:.5} m from the clamp"
            ),
            Self::Friction { mu, sigma, gain } => write!(
                f,
                "the contacts have friction: a coefficient mu = {:.4} +- {sigma:.1e} makes the recording more likely by a factor of 10^{:.0}; K over 2 |F| \
                 along tangential contacts is {:.4}, without friction 0; reconstruct with friction (`--friction estimate`)",
                mu.abs(),
                (gain / std::f64::consts::LN_10).min(999.0),
                mu / mu.hypot(1.0)
            ),
            Self::FrictionGiven { given, mu, sigma, deviation } => write!(
                f,
                "the given coefficient of friction is {:.4}, the recording gives {:.4} +- {sigma:.1e}{}, {deviation:.0} standard deviations away: give \
                 this coefficient, or let it be estimated",
                given.abs(),
                mu.abs(),
                if mu * given < 0.0 { " in the other direction" } else { "" }
            ),
            Self::FrictionChanges { mu, scatter, spread } => write!(
                f,
                "K over 2 |F| along tangential contacts varies by {scatter:.1} times its noise, like a change of mu = {:.4} by {spread:.1e}: the \
                 friction changes along the scan, contacts stick, or there is another error",
                mu.abs()
            ),
            Self::FrictionAgainst { mu, share } => write!(
                f,
                "along {:.0} % of the tangential contacts the estimated friction (mu = {:.4}) acts along the sliding, not against it: there is \
                 another error than friction, or the friction changes its direction",
                100.0 * share,
                mu.abs()
            ),
            Self::NoFreeStretch => f.write_str(
                "the rod is never free in this recording, so that the bias of the sensor is unknown: begin and end scans without \
                 contact, or state the bias",
            ),
            Self::Budget { of, value, sigma, budget } => {
                let unit = of.name().1;
                let space = if unit.is_empty() { "" } else { " " };
                write!(
                    f,
                    "the estimate of the {of} is {value:.3e} +- {sigma:.1e}{space}{unit}, more than three times its budget of \
                     {budget:.1e}{space}{unit}: correct the error, or state a larger budget"
                )
            }
            Self::Misfit { criterion, part } => write!(
                f,
                "after all corrections the residual is {:.0} % of what the budget explains of the {}: friction, taper, hysteresis or another \
                 error that is not in the budget; the contact points may be wrong by more than their standard deviations",
                100.0 * part,
                if criterion == Basis::Criterion { "phase criterion K".to_owned() } else { format!("{criterion} criterion") }
            ),
            Self::Unanswered { share } => write!(
                f,
                "{:.0} % of the samples with a single contact have no contact point; the result gives the reason of each",
                100.0 * share
            ),
            Self::Coarse { channel, step } => write!(
                f,
                "{channel} has steps of {step:.1e} {}, larger than its noise, which hide transitions: record more digits",
                if channel == "m0z" { "N m" } else { "N" }
            ),
            Self::Lost { share } => write!(
                f,
                "{:.0} % of the samples in contact have no contact point: a sign, an axis, a unit or the rod may be wrong",
                100.0 * share
            ),
            Self::KinksWithin { count, from } => write!(
                f,
                "{} within phase B, the first before sample {from}: there the contact passes to another piece of the contour, or a second \
                 contact begins or ends; the noise is too large to decide. With a second contact the errors of the points up to the next change \
                 exceed their standard deviations: scan more slowly, or with less noise",
                if count == 1 { "a kink".to_owned() } else { format!("{count} kinks") }
            ),
            Self::Frozen { share, from } => write!(
                f,
                "{:.1} % of the samples, from sample {from} on, are left out: a reaction stays exactly the same for 40 samples or more; check \
                 the connection, and that the loads are within the range of the sensor",
                100.0 * share
            ),
            Self::Uncertain { share, label, from, to, is_explained } => write!(
                f,
                "about {:.0} % of the labels may be wrong (mean of 1 - probability), the least certain {label} in samples {from} to {}: {}",
                100.0 * share,
                to - 1,
                match is_explained {
                    true => "the forces there do not determine the contact points well; scan closer to the object, or with less noise",
                    false => "scan more slowly, or with less noise",
                }
            ),
            Self::Angle { largest } => {
                write!(f, "phi0 reaches {largest:.4} rad: is it in degrees? Expected radians")
            }
            Self::Way { lengths } => {
                write!(f, "the clamp moves by {lengths:.3e} lengths of the rod: are x0, y0 in another unit? Expected m")
            }
            Self::Unexplained { shares: Shares { beyond_tip, pulling, no_moment_zero, .. }, tangential } => write!(
                f,
                "no single contact on this rod explains {:.0} % of the {}: in {:.0} % it would be beyond the tip, in {:.0} % \
                 it would have to pull, in {:.0} % the moment vanishes nowhere",
                100.0 * (beyond_tip + pulling + no_moment_zero),
                if tangential { "tangential contacts" } else { "scan in contact" },
                100.0 * beyond_tip,
                100.0 * pulling,
                100.0 * no_moment_zero
            ),
        }
    }
}
