//! The conclusions of the check by the physics.

use super::bins::ReactionBin;
use super::finding::{Finding, UNITS};
use super::line::Consensus;
use super::shares::{Shares, contact};
use crate::numeric::CHANCE;
use crate::point::{NoContact, Touch};
use crate::scan::Travel;
use rod_core::{Reactions, Rod, Sample};
use std::f64::consts::TAU;

/// Smallest relative difference of the stiffness that is reported.
const STIFFNESS: f64 = 0.03;
/// Smallest relative difference of the length that is reported.
const LENGTH: f64 = 0.03;
/// Smallest intercept, relative to the largest m0z^2, that is reported. An offset of the moment shifts m0z^2 twice as much, and is
/// reported from half of this on.
const SHIFT: f64 = 0.01;
/// The units are wrong where the slope is within this factor of a power of ten of the stiffness.
pub(super) const NEAR: f64 = 2.0;
/// Smallest share of the scan in contact without a single contact that is reported.
const UNEXPLAINED: f64 = 0.2;
/// Contacts of the tip whose arc lengths differ by no more than this, relative, are all at the tip.
const ALIKE: f64 = 0.01;
/// Path lengths of the clamp beyond this many rod lengths are probably in another unit.
pub(super) const LONG_WAY: f64 = 100.0;
/// Phase criterion, relative to m0z^2, above which (below 0) a contact may be tangential.
const TANGENTIAL: f64 = 0.02;
/// Share of the contacts of the tip at the arc length of the rod, within `ALIKE`, from which on the others are taken for those of several
/// contacts. Larger: scans with a short phase A beside a long BA seem to have a shorter rod.
const AS_GIVEN: f64 = 0.05;
/// Fewest bins that half of the contacts of the tip must be.
const FEWEST_TIPS: usize = 5;

/// The conclusions from line and shares.
pub(super) fn findings(
    rod: &Rod,
    samples: &[Sample],
    bins: &[ReactionBin],
    found: Option<&Consensus>,
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
    // the length is checked with the stiffness of the line
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
        let on = |found: &Consensus| bins.iter().zip(&found.on).filter(|(_, on)| **on).map(|(bin, _)| *bin).collect();
        shares = Shares::of(&rod, &found.map_or_else(|| bins.to_vec(), on));
    }
    if 1.0 - shares.explained > UNEXPLAINED {
        findings.push(Finding::Unexplained { shares, tangential: in_units && found.is_some() });
    }
    findings
}

/// Adds the conclusions from slope and intercept, and returns the stiffness of the line in the units of the recording.
fn of_line(rod: &Rod, bins: &[ReactionBin], found: &Consensus, findings: &mut Vec<Finding>) -> f64 {
    let (line, given) = (&found.line, rod.bending_stiffness());
    let mut ratio = line.slope / given;
    if ratio < 0.0 && line.slope.abs() > CHANCE * line.slope_sigma {
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
    if off > STIFFNESS * given && off > CHANCE * sigma {
        findings.push(Finding::Stiffness { given, suggested, sigma });
    }
    let square = bins.iter().map(|bin| bin.square.abs()).fold(0.0, f64::max);
    if let Some((moment, sigma)) = line.moment_offset
        && moment.abs() > CHANCE * sigma
    {
        let part = moment / square.sqrt();
        if part.abs() > 0.5 * SHIFT {
            findings.push(Finding::MomentOffset { moment, sigma, part });
        }
    } else {
        let part = line.intercept / square;
        if part.abs() > SHIFT && line.intercept.abs() > CHANCE * line.intercept_sigma {
            findings.push(Finding::Intercept { part, force: -0.5 * line.intercept / line.slope });
        }
    }
    line.slope.abs()
}

/// Whether tangential contacts are on the rod only with the opposite sign of the moment.
fn moment_sign(rod: &Rod, bins: &[ReactionBin], found: &Consensus) -> bool {
    let on = || bins.iter().zip(&found.on).filter(|(_, on)| **on).map(|(bin, _)| bin);
    let turned = |bin: &ReactionBin| Reactions { m0z: -bin.reactions.m0z, ..bin.reactions };
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

/// Another length, if half of the contacts of the tip (with a negative phase criterion) are at one arc length.
fn length(rod: &Rod, bins: &[ReactionBin]) -> Option<Finding> {
    let stiffness = rod.bending_stiffness();
    let tip = |bin: &&ReactionBin| {
        let noise = bin.sigma_square.hypot(stiffness * bin.sigma_load);
        let criterion = bin.square - stiffness * bin.load;
        criterion < -CHANCE * noise && criterion < -TANGENTIAL * bin.square.abs()
    };
    let mut lengths: Vec<f64> = bins
        .iter()
        .filter(tip)
        .filter_map(|bin| contact(rod, bin, bin.reactions).map_or_else(|none| none.touch(), Some))
        .map(|touch| touch.s)
        .collect();
    lengths.sort_unstable_by(f64::total_cmp);
    let (half, given) = (lengths.len() / 2, rod.length());
    let as_given = lengths.iter().filter(|s| (*s / given - 1.0).abs() < ALIKE).count();
    if half < FEWEST_TIPS || as_given as f64 > AS_GIVEN * lengths.len() as f64 {
        return None;
    }
    let ranges = lengths.windows(half + 1).map(|part| (part[half] - part[0], part[half / 2]));
    let (range, suggested) = ranges.min_by(|a, b| a.0.total_cmp(&b.0))?;
    let off = (suggested - given).abs();
    (range < ALIKE * suggested && off > LENGTH * given && off > range).then_some(Finding::Length { given, suggested })
}
