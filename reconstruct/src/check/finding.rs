//! What the check by the physics suggests.

use super::bins::Bin;
use super::line::Found;
use super::{Shares, contact};
use crate::point::single::NoContact;
use crate::point::touch::Touch;
use crate::scan::travel::Travel;
use rod_core::{Reactions, Rod, Sample};
use std::f64::consts::TAU;
use std::fmt;

/// Standard errors that are no chance.
const SIGMAS: f64 = 4.0;
/// A length off by so much is none of the rod's.
const MISFIT_LENGTH: f64 = 0.2;
/// How far off, in parts, the stiffness may be before it is told, and before the rod does not fit.
const TOLD: f64 = 0.03;
const MISFIT: f64 = 0.1;
/// How large an intercept is told, in parts of the largest m0z^2, and when the recording does not fit.
const SHIFTED: f64 = 0.01;
const FAR_SHIFTED: f64 = 0.1;
/// The slope is a power of ten of the stiffness within this factor.
const NEAR: f64 = 2.0;
/// Share of the scan in contact that no single contact explains from which on the rod does not fit.
const UNEXPLAINED: f64 = 0.2;
/// How far off, in parts, the length may be.
const LENGTH: f64 = 0.03;
/// Contacts of the tip whose arc lengths differ by no more than this part are all at the tip.
const ALIKE: f64 = 0.01;
/// A way of the clamp of so many lengths of the rod is more likely in another unit.
const LONG_WAY: f64 = 100.0;

/// Units by the power of ten that they give the slope.
const UNITS: [(i32, &str); 8] = [
    (-6, "forces are in uN, or moments in kN mm or N km"),
    (-3, "forces are in mN"),
    (3, "moments are in N mm and forces in mN"),
    (4, "moments are in N cm"),
    (6, "moments are in N mm (or mN m)"),
    (8, "moments are in mN cm and forces in N"),
    (9, "moments are in mN mm and forces in mN"),
    (12, "moments are in mN mm"),
];

/// Something that the check by the physics suggests. Displays as a sentence without its full stop.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Finding {
    /// The rod is free all along.
    NoContact,
    /// There is no line to check anything by.
    NoLine,
    /// The slope is negative.
    Sign,
    /// The slope is about a power of ten of the stiffness.
    Units {
        /// Slope over bending stiffness.
        ratio: f64,
        /// The power.
        power: i32,
    },
    /// The slope is another stiffness.
    Stiffness {
        /// That of the rod, N m^2.
        given: f64,
        /// What the recording suggests, N m^2, in the units that it seems to be in.
        suggested: f64,
        /// Its standard error, N m^2.
        sigma: f64,
    },
    /// The line does not go through the origin.
    Intercept {
        /// The intercept, in parts of the largest m0z^2.
        part: f64,
        /// The force that would have to be taken off the load f0y sin phi0 + f0x cos phi0, N.
        force: f64,
    },
    /// The moment is off by a constant.
    MomentOffset {
        /// By how much, N m.
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
        /// What the recording suggests, m.
        suggested: f64,
    },
    /// The angle of the clamp is many turns.
    Angle {
        /// The largest, radians.
        largest: f64,
    },
    /// The way of the clamp is very long.
    Way {
        /// In lengths of the rod.
        lengths: f64,
    },
    /// Much is explained by no contact on this rod, were it as stiff as the line suggests.
    Unexplained {
        /// By what a single contact makes of it.
        shares: Shares,
        /// Whether of what is on the line, or, where there is none, of all of the scan in contact: that may have several
        /// contacts.
        tangential: bool,
    },
}

impl Finding {
    /// Whether it says that recording, units and rod do not fit together.
    pub fn is_misfit(&self) -> bool {
        match self {
            Self::NoContact | Self::NoLine | Self::Angle { .. } | Self::Way { .. } => false,
            Self::Stiffness { given, suggested, .. } => (suggested / given - 1.0).abs() > MISFIT,
            // where several contacts look like one they may look alike, too: a small difference is a hint at most
            Self::Length { given, suggested } => (suggested / given - 1.0).abs() > MISFIT_LENGTH,
            Self::Intercept { part, .. } | Self::MomentOffset { part, .. } => part.abs() > FAR_SHIFTED,
            Self::Unexplained { tangential, .. } => *tangential,
            Self::Sign | Self::Units { .. } | Self::MomentSign => true,
        }
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::NoContact => f.write_str("the rod touches nothing: there is nothing to check"),
            Self::NoLine => f.write_str(
                "m0z^2 over 2 (f0y sin phi0 + f0x cos phi0) follows no straight line: too few tangential contacts, too \
                 much noise, or angles in another unit than radians",
            ),
            Self::Sign => f.write_str(
                "the slope of m0z^2 over 2 (f0y sin phi0 + f0x cos phi0) is negative: f0x and f0y have the wrong sign, as \
                 loads on the sensor have instead of reactions of the clamp, or phi0 points the other way",
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
                "the bending stiffness is {given:.4e} N m^2, the recording suggests {suggested:.4e} +- {sigma:.1e} N m^2"
            ),
            Self::Intercept { part, force } => write!(
                f,
                "m0z^2 over 2 (f0y sin phi0 + f0x cos phi0) misses the origin by {:.1} % of the largest m0z^2: forces not \
                 tared ({force:.3e} N too much), or moments about another point than the clamp",
                100.0 * part
            ),
            Self::MomentOffset { moment, sigma, part } => write!(
                f,
                "m0z seems to be too large by {moment:.3e} +- {sigma:.1e} N m, {:.1} % of its largest: not tared, or about \
                 another point than the clamp",
                100.0 * part
            ),
            Self::MomentSign => f.write_str("m0z has the wrong sign: with the other one, contacts are on the rod"),
            Self::Length { given, suggested } => write!(
                f,
                "the rod is {given:.5} m long, but contacts of its tip are {suggested:.5} m from the clamp"
            ),
            Self::Angle { largest } => {
                write!(f, "phi0 is up to {largest:.4} rad in size: is it in degrees? Expected radians")
            }
            Self::Way { lengths } => {
                write!(f, "the clamp goes {lengths:.3e} lengths of the rod: are x0, y0 in another unit? Expected m")
            }
            Self::Unexplained { shares: Shares { beyond_tip, pulling, no_moment_zero, .. }, tangential } => write!(
                f,
                "of the {} no single contact on this rod explains {:.0} %: {:.0} % would be beyond the tip, {:.0} % \
                 would have to pull, in {:.0} % the moment vanishes nowhere",
                if tangential { "tangential contacts" } else { "scan in contact" },
                100.0 * (beyond_tip + pulling + no_moment_zero),
                100.0 * beyond_tip,
                100.0 * pulling,
                100.0 * no_moment_zero
            ),
        }
    }
}

/// What line and shares suggest.
pub(super) fn findings(
    rod: &Rod,
    samples: &[Sample],
    bins: &[Bin],
    found: Option<&Found>,
    mut shares: Shares,
) -> Vec<Finding> {
    let mut findings = Vec::new();
    let largest = samples.iter().map(|sample| sample.pose.phi.abs()).filter(|phi| phi.is_finite()).fold(0.0, f64::max);
    if largest > TAU {
        findings.push(Finding::Angle { largest });
    }
    let mut travel = Travel::new(rod);
    let way = samples.iter().fold(0.0, |way, sample| travel.go(&sample.pose).unwrap_or(way));
    if way > LONG_WAY * rod.length() {
        findings.push(Finding::Way { lengths: way / rod.length() });
    }
    // with this stiffness, the length can be looked at
    let mut stiffness = rod.bending_stiffness();
    match found {
        None => findings.push(Finding::NoLine),
        Some(found) => stiffness = of_line(rod, bins, found, &mut findings),
    }
    let in_units = !findings.iter().any(|f| matches!(f, Finding::Sign | Finding::Units { .. } | Finding::Way { .. }));
    if in_units && let Ok(rod) = Rod::new(rod.length(), stiffness) {
        if found.is_some_and(|found| moment_sign(&rod, bins, found)) {
            findings.push(Finding::MomentSign);
            return findings;
        }
        findings.extend(length(&rod, bins));
        let on = |found: &Found| bins.iter().zip(&found.on).filter(|(_, on)| **on).map(|(bin, _)| *bin).collect();
        shares = Shares::of(&rod, &found.map_or_else(|| bins.to_vec(), on));
    }
    if 1.0 - shares.explained > UNEXPLAINED {
        findings.push(Finding::Unexplained { shares, tangential: in_units && found.is_some() });
    }
    findings
}

/// What slope and intercept suggest; the stiffness they suggest, in the recording's own units.
fn of_line(rod: &Rod, bins: &[Bin], found: &Found, findings: &mut Vec<Finding>) -> f64 {
    let (line, given) = (&found.line, rod.bending_stiffness());
    let mut ratio = line.slope / given;
    if ratio < 0.0 && line.slope.abs() > SIGMAS * line.slope_sigma {
        findings.push(Finding::Sign);
    }
    let near = |power: i32| (ratio.abs().log10() - f64::from(power)).abs() < NEAR.log10();
    if let Some(&(power, _)) = UNITS.iter().find(|unit| near(unit.0)) {
        findings.push(Finding::Units { ratio: ratio.abs(), power });
        ratio /= 10_f64.powi(power);
    }
    let suggested = ratio.abs() * given;
    let sigma = line.slope_sigma / line.slope.abs() * suggested;
    let off = (suggested - given).abs();
    if off > TOLD * given && off > SIGMAS * sigma {
        findings.push(Finding::Stiffness { given, suggested, sigma });
    }
    let square = bins.iter().map(|bin| bin.square.abs()).fold(0.0, f64::max);
    if let Some((moment, sigma)) = line.moment_offset
        && moment.abs() > SIGMAS * sigma
    {
        let part = moment / square.sqrt();
        if part.abs() > 0.5 * SHIFTED {
            findings.push(Finding::MomentOffset { moment, sigma, part });
        }
    } else {
        let part = line.intercept / square;
        if part.abs() > SHIFTED && line.intercept.abs() > SIGMAS * line.intercept_sigma {
            findings.push(Finding::Intercept { part, force: -0.5 * line.intercept / line.slope });
        }
    }
    line.slope.abs()
}

/// Whether tangential contacts are on the rod with the moment's sign turned only.
fn moment_sign(rod: &Rod, bins: &[Bin], found: &Found) -> bool {
    let on = || bins.iter().zip(&found.on).filter(|(_, on)| **on).map(|(bin, _)| bin);
    let turned = |bin: &Bin| Reactions { m0z: -bin.reactions.m0z, ..bin.reactions };
    let (mut as_is, mut other, mut nearer) = (0, 0, 0);
    for bin in on() {
        let [here, there] = [bin.reactions, turned(bin)].map(|reactions| contact(rod, bin, reactions));
        as_is += usize::from(here.is_ok());
        other += usize::from(there.is_ok());
        // the rod bends towards the contact, not away from it and back
        let s = |found: Result<Touch, NoContact>| found.map_or(f64::INFINITY, |touch| touch.s);
        nearer += usize::from(s(there) < s(here));
    }
    let count = on().count();
    10 * as_is < 9 * other && 2 * other > count && 2 * nearer > count
}

/// Another length, where half of the contacts of the tip (with a negative phase criterion) are at one arc length.
fn length(rod: &Rod, bins: &[Bin]) -> Option<Finding> {
    let stiffness = rod.bending_stiffness();
    let tip = |bin: &&Bin| {
        let noise = bin.sigma_square.hypot(stiffness * bin.sigma_load);
        let criterion = bin.square - stiffness * bin.load;
        criterion < -SIGMAS * noise && criterion < -SLACK_OF_TIP * bin.square.abs()
    };
    let mut lengths: Vec<f64> = bins
        .iter()
        .filter(tip)
        .filter_map(|bin| contact(rod, bin, bin.reactions).map_or_else(|none| none.touch(), Some))
        .map(|touch| touch.s)
        .collect();
    lengths.sort_unstable_by(f64::total_cmp);
    let (half, given) = (lengths.len() / 2, rod.length());
    let as_given = lengths.iter().filter(|s| (*s / given - 1.0).abs() < LENGTH).count();
    if half < FEWEST_TIPS || 5 * as_given > lengths.len() {
        return None;
    }
    let ranges = lengths.windows(half + 1).map(|part| (part[half] - part[0], part[half / 2]));
    let (range, suggested) = ranges.min_by(|a, b| a.0.total_cmp(&b.0))?;
    let off = (suggested - given).abs();
    (range < ALIKE * suggested && off > LENGTH * given && off > range).then_some(Finding::Length { given, suggested })
}

/// A phase criterion within this part of m0z^2 of zero may be of a tangential contact.
const SLACK_OF_TIP: f64 = 0.02;
/// Fewest bins that half of the contacts of the tip must be.
const FEWEST_TIPS: usize = 5;
