//! The line on which tangential contacts lie, found among all samples.

use super::bins::ReactionBin;
use super::fit::{Columns, Fit, sigma, straight, with_offset};
use crate::numeric::{CHANCE, robust_sigma};

/// Bins of the windows through which lines are tried.
const WINDOWS: [usize; 3] = [8, 24, 72];
/// First tolerance of the distance of a bin from a line, relative to the largest square. Larger: contacts of the tip near the line
/// count, too; smaller: a line is missed where the noise is underestimated.
const WIDE: f64 = 2e-3;
/// Fewest bins on a line.
const FEWEST: usize = 8;
/// Smallest share of the bins that must be on a line.
const SMALLEST_SHARE: f64 = 0.2;
/// Smallest share of the range of the loads that a line must span.
const SHORTEST: f64 = 0.2;
/// Departure of a quadratic from the line, relative to the range of the squares, from which on it is no line.
const BENT: f64 = 0.02;
/// Intercept, relative to the largest square, below which no offset of the moment is looked for.
const ORIGIN: f64 = 5e-3;
/// Offsets of the moment that are tried, on either side of 0.
const OFFSETS: i32 = 20;
/// The largest of them, relative to the largest moment.
const LARGEST_OFFSET: f64 = 0.2;
/// Factor by which more bins must be on the line with an offset of the moment than without.
const MORE: f64 = 1.2;
/// Smallest share of the bins that must be on the line with an offset, if there is none without.
const SMALLEST_SHARE_WITH_OFFSET: f64 = 0.3;
/// Largest scatter of a line beyond the noise, relative to the largest square.
const SCATTER: f64 = 2e-2;
/// The same of a line with an offset of the moment, which fits other curves, too.
const SCATTER_WITH_OFFSET: f64 = 1e-3;
/// Bins on either side with which the mean of a bin must be on the line.
const NEIGHBOURS: usize = 8;
/// Most rounds of fitting and choosing.
const ROUNDS: usize = 30;

/// The straight line that m0z^2 over 2 (f0y sin phi0 + f0x cos phi0) follows wherever the last contact is tangential;
/// its slope is the bending stiffness, and it goes through the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TangentialLine {
    /// Slope, N m^2: the bending stiffness.
    pub slope: f64,
    /// Its standard error, N m^2.
    pub slope_sigma: f64,
    /// Intercept, N^2 m^2: 0 if forces and moments have no offset.
    pub intercept: f64,
    /// Its standard error, N^2 m^2.
    pub intercept_sigma: f64,
    /// Share of the scan in contact that lies on it.
    pub share: f64,
    /// The offset of m0z, N m, and its standard error; the line is then that of the moment without it. None where the line fits as well
    /// without an offset.
    pub moment_offset: Option<(f64, f64)>,
}

/// A line with the bins on it.
pub(super) struct Consensus {
    pub line: TangentialLine,
    pub on: Vec<bool>,
}

/// The line that most bins are on.
pub(super) fn line_of(bins: &[ReactionBin]) -> Option<Consensus> {
    let largest = bins.iter().map(|bin| bin.square.abs()).fold(0.0, f64::max);
    let rounding = f64::EPSILON * 8.0 * largest;
    let plain = consensus(bins, largest)
        .and_then(|start| refine(bins, start, &straight, rounding))
        .filter(|(fit, on)| spans(bins, on) && fit.rest(bins, on, &straight) < SCATTER * largest)
        .filter(|(fit, on)| !is_bent(bins, on, fit.at[0], rounding));
    let through_origin = plain.as_ref().is_some_and(|(fit, _)| fit.at[1].abs() < ORIGIN * largest);
    let offset = if through_origin { None } else { with_offset_of_moment(bins, largest, rounding) };
    let least =
        plain.as_ref().map_or(SMALLEST_SHARE_WITH_OFFSET * bins.len() as f64, |(_, on)| MORE * count(on) as f64);
    if let Some((fit, on)) = offset.filter(|(_, on)| count(on) as f64 > least) {
        let moment_offset = Some((0.5 * fit.at[2], 0.5 * fit.sigma(2)));
        let line = TangentialLine { moment_offset, ..line(&fit, &on) };
        return Some(Consensus { line, on });
    }
    plain.map(|(fit, on)| Consensus { line: line(&fit, &on), on })
}

/// The line of a fit, without an offset of the moment.
fn line<const N: usize>(fit: &Fit<N>, on: &[bool]) -> TangentialLine {
    TangentialLine {
        slope: fit.at[0],
        slope_sigma: fit.sigma(0),
        intercept: fit.at[1],
        intercept_sigma: fit.sigma(1),
        share: count(on) as f64 / on.len() as f64,
        moment_offset: None,
    }
}

/// The line with an offset of the moment, which bends the line without it. The fit starts from that of a range of offsets which leaves
/// most bins on a line.
fn with_offset_of_moment(bins: &[ReactionBin], largest: f64, rounding: f64) -> Option<(Fit<3>, Vec<bool>)> {
    let tried = (-OFFSETS..=OFFSETS).filter_map(|k| {
        let offset = LARGEST_OFFSET * largest.sqrt() * f64::from(k) / f64::from(OFFSETS);
        let shifted = |bin: &ReactionBin| ReactionBin {
            square: bin.square + offset * (offset - 2.0 * bin.reactions.m0z),
            ..*bin
        };
        consensus(&bins.iter().map(shifted).collect::<Vec<_>>(), largest)
    });
    let (on, slope) = tried.max_by_key(|(on, _)| count(on))?;
    refine(bins, (on, slope), &with_offset, rounding)
        .filter(|(fit, on)| spans(bins, on) && fit.rest(bins, on, &with_offset) < SCATTER_WITH_OFFSET * largest)
}

fn count(on: &[bool]) -> usize {
    on.iter().filter(|on| **on).count()
}

/// The bins on the line, through windows of neighbours, that most are on; and its slope.
fn consensus(bins: &[ReactionBin], largest: f64) -> Option<(Vec<bool>, f64)> {
    let wide = WIDE * largest;
    let mut best: Option<(usize, Vec<bool>, f64)> = None;
    for length in WINDOWS {
        for window in bins.windows(length).step_by((length / 4).max(1)) {
            let Some((slope, intercept)) = through(window) else { continue };
            let off = |bin: &ReactionBin| (bin.square - intercept - slope * bin.load).abs();
            let on = |bin: &ReactionBin| off(bin) <= wide.max(CHANCE * sigma(bin, slope));
            // a window that is not straight itself has no tangential contacts
            if !window.iter().all(on) {
                continue;
            }
            let on: Vec<bool> = bins.iter().map(on).collect();
            let count = count(&on);
            if best.as_ref().is_none_or(|best| count > best.0) && spans(bins, &on) {
                best = Some((count, on, slope));
            }
        }
    }
    best.map(|(_, on, slope)| (on, slope))
}

/// Slope and intercept by least squares.
fn through(window: &[ReactionBin]) -> Option<(f64, f64)> {
    let n = window.len() as f64;
    let mean = |of: fn(&ReactionBin) -> f64| window.iter().map(of).sum::<f64>() / n;
    let (x, y) = (mean(|bin| bin.load), mean(|bin| bin.square));
    let sums = window
        .iter()
        .fold((0.0, 0.0), |(xx, xy), bin| (xx + (bin.load - x).powi(2), xy + (bin.load - x) * (bin.square - y)));
    let slope = sums.1 / sums.0;
    slope.is_finite().then_some((slope, y - slope * x))
}

/// Whether enough bins are on a line, over enough of the range of loads.
fn spans(bins: &[ReactionBin], on: &[bool]) -> bool {
    let range = |loads: &mut dyn Iterator<Item = f64>| {
        let (least, most) = loads.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
        most - least
    };
    let count = count(on);
    let all = range(&mut bins.iter().map(|bin| bin.load));
    let part = range(&mut bins.iter().zip(on).filter(|(_, on)| **on).map(|(bin, _)| bin.load));
    count >= FEWEST && count as f64 >= SMALLEST_SHARE * bins.len() as f64 && part >= SHORTEST * all
}

/// Fits, and chooses the bins on the fit by their noise or their scatter, until the choice stays the same. The mean of a bin and its
/// neighbours must be on the fit, too: contacts of the tip come near the line, and then all depart to the same side.
fn refine<const N: usize>(
    bins: &[ReactionBin],
    (mut on, mut slope): (Vec<bool>, f64),
    columns: Columns<'_, N>,
    rounding: f64,
) -> Option<(Fit<N>, Vec<bool>)> {
    let mut fit = Fit::of(bins, &on, columns, slope, rounding)?;
    for _ in 0..ROUNDS {
        slope = fit.at[0];
        let alone: Vec<f64> = bins.iter().map(|bin| fit.off(bin, columns) / sigma(bin, slope).max(rounding)).collect();
        let together = with_neighbours(&alone);
        let most = [&alone, &together].map(|z| CHANCE * scatter(z, &on).max(1.0));
        let next: Vec<bool> =
            alone.iter().zip(&together).map(|(a, t)| a.abs() <= most[0] && t.abs() <= most[1]).collect();
        let same = next == on;
        on = next;
        fit = Fit::of(bins, &on, columns, slope, rounding)?;
        if same {
            break;
        }
    }
    Some((fit, on))
}

/// Means with the neighbours on both sides, in their own standard deviations.
fn with_neighbours(alone: &[f64]) -> Vec<f64> {
    let about = |k: usize| &alone[k.saturating_sub(NEIGHBOURS)..(k + NEIGHBOURS + 1).min(alone.len())];
    (0..alone.len()).map(|k| about(k).iter().sum::<f64>() / (about(k).len() as f64).sqrt()).collect()
}

/// Standard deviation of those that are on the line, by their median.
fn scatter(z: &[f64], on: &[bool]) -> f64 {
    robust_sigma(z.iter().zip(on).filter(|(_, on)| **on).map(|(z, _)| *z)).unwrap_or(0.0)
}

/// Whether a parabola fits significantly better than the line, and departs from it.
fn is_bent(bins: &[ReactionBin], on: &[bool], slope: f64, rounding: f64) -> bool {
    let loads = || bins.iter().zip(on).filter(|(_, on)| **on).map(|(bin, _)| bin.load);
    let (least, most) = loads().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
    let middle = 0.5 * (least + most);
    let quadratic = move |bin: &ReactionBin| [bin.load, 1.0, (bin.load - middle).powi(2)];
    let Some(fit) = Fit::of(bins, on, &quadratic, slope, rounding) else { return false };
    let half = 0.5 * (most - least);
    let bent = fit.at[2].abs() * half * half;
    bent > BENT * (fit.at[0] * 2.0 * half).abs() && fit.at[2].abs() > CHANCE * fit.sigma(2)
}
