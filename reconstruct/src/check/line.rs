//! The line on which tangential contacts lie, found among everything else.

use super::bins::Bin;
use nalgebra::{DMatrix, DVector};

/// Bins of the windows that lines are tried through.
const WINDOWS: [usize; 3] = [8, 24, 72];
/// How far off a line a bin may be at first, in parts of the largest square.
const WIDE: f64 = 2e-3;
/// Bins within so many standard deviations are on a line.
const SIGMAS: f64 = 4.0;
/// Fewest bins on a line, the least part of the bins, and of the range of the loads that they must span.
const FEWEST: usize = 8;
const LEAST_SHARE: f64 = 0.2;
const LEAST_SPAN: f64 = 0.2;
/// A quadratic that departs from the line by this part of the squares' range is no line.
const BENT: f64 = 0.02;
/// A line that misses the origin by less, in parts of the largest square, needs no offset of the moment.
const ORIGIN: f64 = 5e-3;
/// Offsets of the moment that are tried, to either side, and the largest, in parts of the largest moment.
const OFFSETS: i32 = 20;
const LARGEST_OFFSET: f64 = 0.2;
/// With an offset of the moment taken into account, so many times as much of the scan must be on the line; or so much
/// of it where there is no line otherwise.
const MORE: f64 = 1.2;
const LEAST_WITH_OFFSET: f64 = 0.3;
/// What may be left beyond the noise, in parts of the largest square; and where an offset of the moment is fitted, too.
const SCATTER: f64 = 2e-2;
const SCATTER_WITH_OFFSET: f64 = 1e-3;
/// Bins on either side that a bin must be on the line with.
const NEIGHBOURS: usize = 8;
/// Rounds of fitting and choosing.
const ROUNDS: usize = 30;

/// The straight line that m0z^2 over 2 (f0y sin phi0 + f0x cos phi0) follows wherever the last contact is tangential;
/// its slope is the bending stiffness, and it goes through the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TangentialLine {
    /// Slope, N m^2: the bending stiffness.
    pub slope: f64,
    /// Its standard error, N m^2.
    pub slope_sigma: f64,
    /// Intercept, N^2 m^2: 0 where forces and moments are.
    pub intercept: f64,
    /// Its standard error, N^2 m^2.
    pub intercept_sigma: f64,
    /// Share of the scan in contact that lies on it.
    pub share: f64,
    /// What m0z is too large by, N m, and its standard error: the line is then that of the moment without it. None
    /// where the line holds as well as it is.
    pub moment_offset: Option<(f64, f64)>,
}

/// A line with the bins on it.
pub(super) struct Found {
    pub line: TangentialLine,
    pub on: Vec<bool>,
}

/// A polynomial in the load, and the moment: what is fitted.
type Columns<'a> = &'a dyn Fn(&Bin) -> Vec<f64>;

struct Fit {
    at: DVector<f64>,
    covariance: DMatrix<f64>,
}

impl Fit {
    /// Weighted least squares; standard errors by the scatter where that is more than the noise.
    fn of(bins: &[Bin], on: &[bool], columns: Columns<'_>, slope: f64, floor: f64) -> Option<Self> {
        let used: Vec<&Bin> = bins.iter().zip(on).filter(|(_, on)| **on).map(|(bin, _)| bin).collect();
        let width = columns(used.first()?).len();
        if used.len() <= width {
            return None;
        }
        let rows: Vec<Vec<f64>> = used.iter().map(|bin| columns(bin)).collect();
        let sigma: Vec<f64> = used.iter().map(|bin| sigma(bin, slope).max(floor)).collect();
        // Columns of one size: squares of newtons and newton metres are far apart.
        let scale: Vec<f64> = (0..width)
            .map(|c| rows.iter().map(|row| row[c].abs()).fold(0.0, f64::max))
            .map(|largest| if largest > 0.0 { largest } else { 1.0 })
            .collect();
        let matrix = DMatrix::from_fn(used.len(), width, |i, c| rows[i][c] / scale[c] / sigma[i]);
        let right = DVector::from_fn(used.len(), |i, _| used[i].square / sigma[i]);
        let normal = (matrix.transpose() * &matrix).cholesky()?;
        let at = normal.solve(&(matrix.transpose() * &right));
        let rest = (&matrix * &at - &right).norm_squared() / (used.len() - width) as f64;
        let unscale = |c: usize| 1.0 / scale[c];
        let covariance = normal.inverse() * rest.max(1.0);
        Some(Self {
            at: DVector::from_fn(width, |c, _| at[c] * unscale(c)),
            covariance: DMatrix::from_fn(width, width, |a, b| covariance[(a, b)] * unscale(a) * unscale(b)),
        })
    }

    fn sigma(&self, column: usize) -> f64 {
        self.covariance[(column, column)].max(0.0).sqrt()
    }

    /// What is left beyond the noise: root of the mean square.
    fn rest(&self, bins: &[Bin], on: &[bool], columns: Columns<'_>) -> f64 {
        let used = || bins.iter().zip(on).filter(|(_, on)| **on).map(|(bin, _)| bin);
        let excess = |bin: &Bin| self.off(bin, columns).powi(2) - sigma(bin, self.at[0]).powi(2);
        (used().map(excess).sum::<f64>() / used().count().max(1) as f64).max(0.0).sqrt()
    }

    fn off(&self, bin: &Bin, columns: Columns<'_>) -> f64 {
        bin.square - columns(bin).iter().zip(&self.at).map(|(column, at)| column * at).sum::<f64>()
    }
}

fn straight(bin: &Bin) -> Vec<f64> {
    vec![bin.load, 1.0]
}

fn with_offset(bin: &Bin) -> Vec<f64> {
    vec![bin.load, 1.0, bin.reactions.m0z]
}

/// Standard deviation of the distance from a line of this slope.
fn sigma(bin: &Bin, slope: f64) -> f64 {
    bin.sigma_square.hypot(slope * bin.sigma_load)
}

/// The line that most bins are on.
pub(super) fn find(bins: &[Bin]) -> Option<Found> {
    let largest = bins.iter().map(|bin| bin.square.abs()).fold(0.0, f64::max);
    let rounding = f64::EPSILON * 8.0 * largest;
    let plain = consensus(bins, largest)
        .and_then(|start| refine(bins, start, &straight, rounding))
        .filter(|(fit, on)| spans(bins, on) && fit.rest(bins, on, &straight) < SCATTER * largest)
        .filter(|(fit, on)| !is_bent(bins, on, fit.at[0], rounding));
    let through_origin = plain.as_ref().is_some_and(|(fit, _)| fit.at[1].abs() < ORIGIN * largest);
    let offset = if through_origin { None } else { with_offset_of_moment(bins, largest, rounding) };
    let least = plain.as_ref().map_or(LEAST_WITH_OFFSET * bins.len() as f64, |(_, on)| MORE * count(on) as f64);
    let offset = offset.filter(|(_, on)| count(on) as f64 > least);
    let moment_offset = offset.as_ref().map(|(fit, _)| (0.5 * fit.at[2], 0.5 * fit.sigma(2)));
    let (fit, on) = offset.or(plain)?;
    let line = TangentialLine {
        slope: fit.at[0],
        slope_sigma: fit.sigma(0),
        intercept: fit.at[1],
        intercept_sigma: fit.sigma(1),
        share: count(&on) as f64 / bins.len() as f64,
        moment_offset,
    };
    Some(Found { line, on })
}

/// The line where a moment that is off bends it: of a range of offsets, the one that leaves most bins on a line is
/// where the fit starts.
fn with_offset_of_moment(bins: &[Bin], largest: f64, rounding: f64) -> Option<(Fit, Vec<bool>)> {
    let tried = (-OFFSETS..=OFFSETS).filter_map(|k| {
        let offset = LARGEST_OFFSET * largest.sqrt() * f64::from(k) / f64::from(OFFSETS);
        let shifted = |bin: &Bin| Bin { square: bin.square + offset * (offset - 2.0 * bin.reactions.m0z), ..*bin };
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
fn consensus(bins: &[Bin], largest: f64) -> Option<(Vec<bool>, f64)> {
    let wide = WIDE * largest;
    let mut best: Option<(usize, Vec<bool>, f64)> = None;
    for length in WINDOWS {
        for window in bins.windows(length).step_by((length / 4).max(1)) {
            let Some((slope, intercept)) = through(window) else { continue };
            let off = |bin: &Bin| (bin.square - intercept - slope * bin.load).abs();
            let on = |bin: &Bin| off(bin) <= wide.max(SIGMAS * sigma(bin, slope));
            // a window that is not straight itself is none to start from
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
fn through(window: &[Bin]) -> Option<(f64, f64)> {
    let n = window.len() as f64;
    let mean = |of: fn(&Bin) -> f64| window.iter().map(of).sum::<f64>() / n;
    let (x, y) = (mean(|bin| bin.load), mean(|bin| bin.square));
    let sums = window
        .iter()
        .fold((0.0, 0.0), |(xx, xy), bin| (xx + (bin.load - x).powi(2), xy + (bin.load - x) * (bin.square - y)));
    let slope = sums.1 / sums.0;
    slope.is_finite().then_some((slope, y - slope * x))
}

/// Whether enough bins are on a line, over enough of the range of loads.
fn spans(bins: &[Bin], on: &[bool]) -> bool {
    let range = |loads: &mut dyn Iterator<Item = f64>| {
        let (least, most) = loads.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
        most - least
    };
    let count = count(on);
    let all = range(&mut bins.iter().map(|bin| bin.load));
    let part = range(&mut bins.iter().zip(on).filter(|(_, on)| **on).map(|(bin, _)| bin.load));
    count >= FEWEST && count as f64 >= LEAST_SHARE * bins.len() as f64 && part >= LEAST_SPAN * all
}

/// Fits, and chooses the bins on the fit by their noise or their scatter, until nothing changes. A bin must be on it
/// with its neighbours: contacts of the tip come near the line, and are then a little off it all together.
fn refine(
    bins: &[Bin],
    (mut on, mut slope): (Vec<bool>, f64),
    columns: Columns<'_>,
    rounding: f64,
) -> Option<(Fit, Vec<bool>)> {
    let mut fit = Fit::of(bins, &on, columns, slope, rounding)?;
    for _ in 0..ROUNDS {
        slope = fit.at[0];
        let alone: Vec<f64> = bins.iter().map(|bin| fit.off(bin, columns) / sigma(bin, slope).max(rounding)).collect();
        let together = with_neighbours(&alone);
        let most = [&alone, &together].map(|z| SIGMAS * scatter(z, &on).max(1.0));
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
    let mut sizes: Vec<f64> = z.iter().zip(on).filter(|(_, on)| **on).map(|(z, _)| z.abs()).collect();
    sizes.sort_unstable_by(f64::total_cmp);
    // the median of |z| of a normal variable is 0.6745
    sizes.get(sizes.len() / 2).map_or(0.0, |median| median / 0.6745)
}

/// Whether a parabola fits better than the line, and is another thing.
fn is_bent(bins: &[Bin], on: &[bool], slope: f64, rounding: f64) -> bool {
    let loads = || bins.iter().zip(on).filter(|(_, on)| **on).map(|(bin, _)| bin.load);
    let (least, most) = loads().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
    let middle = 0.5 * (least + most);
    let quadratic = move |bin: &Bin| vec![bin.load, 1.0, (bin.load - middle).powi(2)];
    let Some(fit) = Fit::of(bins, on, &quadratic, slope, rounding) else { return false };
    let half = 0.5 * (most - least);
    let bent = fit.at[2].abs() * half * half;
    bent > BENT * (fit.at[0] * 2.0 * half).abs() && fit.at[2].abs() > SIGMAS * fit.sigma(2)
}
