//! What several scans say of the errors that stay the same from scan to scan.

use super::calibration::{Calibration, SourceEstimate, confounders_of, ties};
use super::known::Known;
use super::source::Source;
use crate::numeric::chi_squared::wilson_hilferty;
use nalgebra::{DMatrix, DVector, SymmetricEigen};
use rod_core::Rod;
use std::collections::BTreeSet;

/// Smallest variance of an estimate, in parts of the variance of its budget: 1e-6 of a standard deviation, what rounding leaves of
/// noise-free scans. Larger: scans count for less than they say.
const FINEST: f64 = 1e-12;
/// What a scan must say of a combination of sources, in parts of what is known already, to be compared with that. Smaller: rounding
/// errors count.
const TELLING: f64 = 0.01;
/// Standard normal quantile of the probability 1e-3, with which scans that agree are said to contradict each other.
const QUANTILE: f64 = 3.09;

/// The errors that stay the same from scan to scan, as several scans of one rod and sensor tell them together: all but bias and drift.
///
/// Each scan gives an estimate with covariance that contains the same prior knowledge. Their information matrices are added, and the
/// prior counts once. The coefficient of friction is one for each recording: its passes there and back share it, with the sign of
/// their direction, which is how it is told from errors that have no direction.
#[derive(Clone, Debug, PartialEq)]
pub struct Combined {
    /// The sources, and behind them the coefficient of friction of each recording, in order of their numbers, where that is estimated. The
    /// estimates that are `taken` are the fewest that agree with the scans; the other sources keep what was known.
    pub sources: Vec<SourceEstimate>,
    /// Covariance of the estimates, in the order and the units of the sources.
    pub covariance: DMatrix<f64>,
    /// Pairs that the scans do not tell apart: their estimates have a correlation beyond 0.9 in size, which is given.
    pub ties: Vec<(Source, Source, f64)>,
    /// Squared differences of each scan from those before it, in standard deviations: chi-squared where the scans agree.
    pub chi_squared: f64,
    /// Its degrees of freedom: 0 for one scan.
    pub freedom: usize,
}

/// What is estimated of several scans.
#[derive(Clone, Copy, PartialEq)]
enum CommonSource {
    /// A source of all scans, by its number among those of a scan.
    Same(usize),
    /// Friction of the scans of one recording, by its number among the sources.
    Friction(usize, usize),
}

impl CommonSource {
    /// Its estimate in a scan, relative to what was known, and its sign there; none where the scan tells nothing of it.
    fn of(self, (recording, scan): &(usize, Calibration)) -> Option<(usize, f64)> {
        match self {
            Self::Same(k) => Some((k, 1.0)),
            Self::Friction(k, of) => (of == *recording).then_some((k, scan.direction)),
        }
    }
}

impl Combined {
    /// Of the calibrations of scans with the same budget and rod, each with the number of its recording. None without a scan, where the
    /// scans have other sources, and where all budgets are 0.
    pub fn of(scans: &[(usize, Calibration)]) -> Option<Self> {
        let first = &scans.first()?.1.sources;
        let alike = |(_, scan): &(usize, Calibration)| {
            scan.covariance.nrows() == scan.sources.len()
                && scan.sources.iter().map(|estimate| estimate.source).eq(first.iter().map(|e| e.source))
        };
        if !scans.iter().all(alike) {
            return None;
        }
        let same = (0..first.len()).filter(|k| !first[*k].source.is_of_scan()).map(CommonSource::Same);
        let friction = first.iter().position(|estimate| estimate.source == Source::Friction);
        let recordings: BTreeSet<usize> = scans.iter().map(|scan| scan.0).collect();
        let frictions = friction.iter().flat_map(|k| recordings.iter().map(|of| CommonSource::Friction(*k, *of)));
        let unknowns: Vec<CommonSource> = same.chain(frictions).collect();
        let count = unknowns.len();
        let of = |unknown: CommonSource| {
            scans.iter().filter_map(move |scan| unknown.of(scan).map(|(k, sign)| (scan.1.sources[k], sign)))
        };
        // in units of the largest budget; where that is 0, nothing changes
        let largest = |unknown: &CommonSource| of(*unknown).map(|one| one.0.budget).fold(0.0, f64::max);
        let budgets: Vec<f64> = unknowns.iter().map(largest).collect();
        let unit = |k: usize| if budgets[k] > 0.0 { budgets[k] } else { 1.0 };
        if budgets.iter().all(|budget| *budget == 0.0) {
            return None;
        }
        let known = unknowns.iter().map(|unknown| of(*unknown).next().map(|(one, sign)| sign * one.known));
        let known: Vec<f64> = known.collect::<Option<_>>()?;
        let mut found = DVector::<f64>::zeros(count);
        let mut factor = DMatrix::from_fn(count, count, |i, j| f64::from(u8::from(i == j && budgets[i] > 0.0)));
        let (mut chi_squared, mut freedom) = (0.0, 0);
        for (number, scan) in scans.iter().enumerate() {
            let places: Vec<Option<(usize, f64)>> =
                (0..count).map(|k| unknowns[k].of(scan).filter(|_| budgets[k] > 0.0)).collect();
            let covariance = DMatrix::from_fn(count, count, |i, j| match (places[i], places[j]) {
                (Some((a, by_a)), Some((b, by_b))) => by_a * by_b * scan.1.covariance[(a, b)] / (unit(i) * unit(j)),
                _ => f64::from(u8::from(i == j)),
            });
            let estimate = |k: usize| places[k].map(|(place, sign)| (scan.1.sources[place], sign));
            let prior =
                DVector::from_fn(count, |k, _| estimate(k).map_or(1.0, |(one, _)| (budgets[k] / one.budget).powi(2)));
            let off = DVector::from_fn(count, |k, _| {
                estimate(k).map_or(0.0, |(one, sign)| sign * (one.value - one.known) / unit(k))
            });
            // of friction each scan knows another value before
            let from = DVector::from_fn(count, |k, _| {
                estimate(k).map_or(0.0, |(one, sign)| (sign * one.known - known[k]) / unit(k))
            });
            let whole = map_eigenvalues(covariance, |variance| 1.0 / variance.max(FINEST));
            let told = map_eigenvalues(&whole - DMatrix::from_diagonal(&prior), |information| information.max(0.0));
            let right = &whole * off + &told * from;
            // what the scan says, in combinations of which nothing is known but a standard deviation of 1
            let eigen = SymmetricEigen::new(factor.transpose() * &told * &factor);
            let surprise = eigen.eigenvectors.transpose() * factor.transpose() * (right - told * &found);
            let information = eigen.eigenvalues.map(|value| value.max(0.0));
            if number > 0 {
                let telling = (0..count).filter(|k| information[*k] > TELLING);
                for k in telling {
                    chi_squared += surprise[k].powi(2) / (information[k] * (1.0 + information[k]));
                    freedom += 1;
                }
            }
            let combinations = &factor * eigen.eigenvectors;
            found += &combinations * surprise.zip_map(&information, |s, i| s / (1.0 + i));
            factor = combinations * DMatrix::from_diagonal(&information.map(|i| 1.0 / (1.0 + i).sqrt()));
        }
        let covariance = &factor * factor.transpose();
        let covariance = DMatrix::from_fn(count, count, |i, j| covariance[(i, j)] * unit(i) * unit(j));
        let active: Vec<usize> = (0..count).filter(|k| budgets[*k] > 0.0).collect();
        let is_friction = |k: &usize| matches!(unknowns[active[*k]], CommonSource::Friction(..));
        let frictions: Vec<usize> = (0..active.len()).filter(is_friction).collect();
        let taken = sparsest_estimate(&found, &(&factor * factor.transpose()), &active, frictions);
        let sources: Option<Vec<SourceEstimate>> = (0..count)
            .map(|k| {
                let (first, _) = of(unknowns[k]).next()?;
                let [value, taken] = [found[k], taken[k]].map(|off| known[k] + off * unit(k));
                let raised = of(unknowns[k]).any(|one| one.0.raised);
                let sigma = covariance[(k, k)].max(0.0).sqrt();
                Some(SourceEstimate { known: known[k], budget: budgets[k], value, sigma, taken, raised, ..first })
            })
            .collect();
        let sources = sources?;
        let ties = ties(&sources, &covariance);
        Some(Self { sources, covariance, ties, chi_squared, freedom })
    }

    /// Whether the scans contradict each other: agreeing ones differ as much with a probability of 1e-3.
    pub fn contradicts(&self) -> bool {
        self.freedom > 0 && self.chi_squared > wilson_hilferty(self.freedom, QUANTILE)
    }

    /// The sources that the scans separate poorly from one of [`Self::sources`], by its number, as [`Calibration::confounders`] of one scan.
    pub fn confounders(&self, of: usize) -> Vec<(Source, f64)> {
        if of < self.sources.len() { confounders_of(&self.sources, &self.covariance, of) } else { Vec::new() }
    }

    /// The estimate of one source.
    pub fn source(&self, source: Source) -> Option<&SourceEstimate> {
        self.sources.iter().find(|estimate| estimate.source == source)
    }

    /// The rod with length and stiffness as they are taken, and what is known of it then. For [`Settings`](crate::Settings) of later scans.
    /// The standard deviations contain what of an estimate is not taken.
    pub fn known(&self, given: &Rod) -> (Rod, Known) {
        let value = |source| self.source(source).map_or(0.0, |estimate| estimate.taken);
        let (length, stiffness) = (1.0 + value(Source::Length), 1.0 + value(Source::Stiffness));
        let rod = Rod::new(given.length() * length, given.bending_stiffness() * stiffness);
        let Ok(rod) = rod else { return (*given, Known::NOTHING) };
        let same = self.sources.iter().filter(|estimate| !estimate.source.is_of_scan());
        let known = same.fold(Known::NOTHING, |known, estimate| {
            let SourceEstimate { source, taken: value, sigma, .. } = *estimate;
            let sigma = sigma.hypot(estimate.value - value);
            match source {
                Source::Length => known.with(source, 0.0, sigma / length),
                Source::Stiffness => known.with(source, 0.0, sigma / stiffness),
                // relative to the length of the rod
                Source::M0zInF0x | Source::M0zInF0y => known.with(source, value * length, sigma * length),
                Source::F0xInM0z | Source::F0yInM0z => known.with(source, value / length, sigma / length),
                _ => known.with(source, value, sigma),
            }
        });
        (rod, known)
    }
}

/// The sparsest estimate that agrees with `found` and its covariance: those `kept` of the active sources, and one source after the other, each
/// the one that explains most of what is left.
fn sparsest_estimate(
    found: &DVector<f64>,
    covariance: &DMatrix<f64>,
    active: &[usize],
    mut kept: Vec<usize>,
) -> DVector<f64> {
    let count = active.len();
    let part = DMatrix::from_fn(count, count, |i, j| covariance[(active[i], active[j])]);
    let information = map_eigenvalues(part, |variance| 1.0 / variance.max(FINEST));
    let off = DVector::from_fn(count, |k, _| found[active[k]]);
    let allowed = wilson_hilferty(count, QUANTILE);
    // the estimate with these sources alone, and by how much its sum of squares is larger
    let with = |kept: &[usize]| {
        let right = &information * &off;
        let only = DMatrix::from_fn(kept.len(), kept.len(), |i, j| information[(kept[i], kept[j])]);
        let solved = only.cholesky()?.solve(&DVector::from_fn(kept.len(), |k, _| right[kept[k]]));
        let mut taken = DVector::<f64>::zeros(count);
        kept.iter().zip(solved.iter()).for_each(|(k, value)| taken[*k] = *value);
        let left = &off - &taken;
        Some((left.dot(&(&information * &left)), taken))
    };
    let mut best = with(&kept).unwrap_or_else(|| (off.dot(&(&information * &off)), DVector::zeros(count)));
    while best.0 > allowed && kept.len() < count {
        let others = (0..count).filter(|k| !kept.contains(k));
        let tried = others.filter_map(|k| Some((k, with(&[kept.as_slice(), &[k]].concat())?)));
        let Some((k, next)) = tried.min_by(|a, b| a.1.0.total_cmp(&b.1.0)) else { break };
        kept.push(k);
        best = next;
    }
    let mut taken = DVector::zeros(found.len());
    active.iter().zip(best.1.iter()).for_each(|(k, value)| taken[*k] = *value);
    taken
}

/// A symmetric matrix with other eigenvalues.
fn map_eigenvalues(matrix: DMatrix<f64>, of: impl Fn(f64) -> f64) -> DMatrix<f64> {
    let eigen = SymmetricEigen::new(matrix);
    let values = DMatrix::from_diagonal(&eigen.eigenvalues.map(of));
    &eigen.eigenvectors * values * eigen.eigenvectors.transpose()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A scan that measures the sum of two sources and nothing else.
    fn scan(sum: f64, sigma: f64) -> Calibration {
        scan_of([Source::GainF0x, Source::Stiffness], sum, sigma)
    }

    fn scan_of(of: [Source; 2], sum: f64, sigma: f64) -> Calibration {
        let budget = 2.0;
        let estimate = |source| {
            // posterior of two independent variables of variance b^2 whose sum is measured
            let gain = budget * budget / (2.0 * budget * budget + sigma * sigma);
            let deviation = (budget * budget * (1.0 - gain)).sqrt();
            SourceEstimate {
                source,
                known: 0.0,
                given: budget,
                budget,
                value: gain * sum,
                sigma: deviation,
                taken: gain * sum,
                raised: false,
            }
        };
        let sources = of.map(estimate).to_vec();
        let (variance, both) = (sources[0].sigma.powi(2), -budget.powi(4) / (2.0 * budget * budget + sigma * sigma));
        Calibration {
            sources,
            covariance: DMatrix::from_row_slice(2, 2, &[variance, both, both, variance]),
            ties: Vec::new(),
            free: Vec::new(),
            direction: 1.0,
            log_likelihood: 0.0,
            misfit_criterion: 0.0,
            misfit_length: 0.0,
            misfit_tangent: 0.0,
        }
    }

    #[test]
    fn scans_add_their_information_and_the_prior_counts_once() {
        let alone = Combined::of(&[(0, scan(1.0, 0.2))]).unwrap();
        assert_eq!(alone.freedom, 0);
        assert!((alone.sources[0].value - scan(1.0, 0.2).sources[0].value).abs() < 1e-12);
        assert!((&alone.covariance - scan(1.0, 0.2).covariance).amax() < 1e-12);
        // four scans are one with half the noise
        let four = Combined::of(&[0.9, 1.1, 0.8, 1.2].map(|sum| (0, scan(sum, 0.2)))).unwrap();
        let one = scan(1.0, 0.1);
        assert!((&four.covariance - one.covariance).amax() < 1e-10, "{}", four.covariance);
        assert!((four.sources[1].value - one.sources[1].value).abs() < 1e-10);
        // the differences are of one combination only
        assert_eq!((four.freedom, four.contradicts()), (3, false));
        assert_eq!(four.ties.len(), 1);
        // chi-squared is the sum of squares about the mean, but for the prior, which is weak
        let expected = [0.1_f64, 0.1, 0.2, 0.2].iter().map(|off| (off / 0.2).powi(2)).sum::<f64>();
        assert!((four.chi_squared - expected).abs() < 0.01 * expected, "{} {expected}", four.chi_squared);
        let apart = Combined::of(&[(0, scan(1.0, 0.2)), (1, scan(3.0, 0.2))]).unwrap();
        assert!(apart.contradicts());
    }

    /// The scans measure the sum of the angle and of friction, which has the sign of the direction; each knows another value before.
    #[test]
    fn directions_tell_friction_of_one_recording_apart() {
        let (angle, sigma) = (0.03, 1e-3);
        let pass = |recording: usize, direction: f64, mu: f64| {
            let about = direction * mu + 0.01;
            let mut scan = scan_of([Source::ClampAngle, Source::Friction], angle + direction * mu - about, sigma);
            scan.sources[1].known += about;
            scan.sources[1].value += about;
            (recording, Calibration { direction, ..scan })
        };
        let both = Combined::of(&[pass(0, 1.0, 0.2), pass(0, -1.0, 0.2)]).unwrap();
        let [of_angle, of_friction] = [both.sources[0], both.sources[1]];
        assert!((of_angle.value - angle).abs() < 1e-6 && (of_friction.value - 0.2).abs() < 1e-6, "{both:?}");
        for one in [of_angle, of_friction] {
            assert!((one.sigma - sigma / 2_f64.sqrt()).abs() < 1e-3 * sigma, "{one:?}");
        }
        assert!(both.ties.is_empty() && both.confounders(1).is_empty() && !both.contradicts());
        // another recording has another coefficient, which its two directions, but not one of them, tell
        let four = [pass(0, 1.0, 0.2), pass(0, -1.0, 0.2), pass(1, -1.0, 0.4), pass(1, 1.0, 0.4)];
        let two = Combined::of(&four).unwrap();
        assert!((two.sources[2].value - 0.4).abs() < 1e-6 && two.sources.len() == 3 && !two.contradicts(), "{two:?}");
        let apart = Combined::of(&[pass(0, 1.0, 0.2), pass(1, -1.0, 0.2)]).unwrap();
        assert!(apart.sources.iter().all(|one| one.sigma > 0.5), "{apart:?}");
        assert!(apart.ties.len() == 3 && apart.ties.iter().all(|tie| tie.1 == Source::Friction), "{apart:?}");
        let (other, part) = apart.confounders(1)[0];
        assert!(part > 0.99 && [Source::ClampAngle, Source::Friction].contains(&other), "{apart:?}");
        // friction is of the scans, not of the rod
        assert_eq!(both.known(&Rod::new(1.0, 1.0).unwrap()).1.of(Source::Friction), None);
    }

    #[test]
    fn what_is_found_of_the_rod_goes_into_the_rod() {
        let rod = Rod::new(0.1, 1e-3).unwrap();
        let combined = Combined::of(&[(0, scan(1.0, 0.2))]).unwrap();
        let (found, known) = combined.known(&rod);
        let stiffness = combined.source(Source::Stiffness).unwrap();
        // one of the two explains the sum, no more than the other
        let (taken, left) = (1.0 + stiffness.taken, stiffness.value - stiffness.taken);
        assert!((found.bending_stiffness() - 1e-3 * taken).abs() < 1e-18);
        assert_eq!(known.of(Source::Stiffness), Some((0.0, stiffness.sigma.hypot(left) / taken)));
        let gain = combined.source(Source::GainF0x).unwrap();
        assert!((stiffness.taken == 0.0) != (gain.taken == 0.0));
        assert!((stiffness.taken + gain.taken - 1.0).abs() < 0.02, "{stiffness:?} {gain:?}");
        // little is nothing
        let combined = Combined::of(&[(0, scan(0.1, 0.2))]).unwrap();
        assert!(combined.sources.iter().all(|source| source.taken == 0.0));
        assert_eq!(known.of(Source::BiasF0x), None);
    }
}
