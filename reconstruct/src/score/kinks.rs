//! How many of the true kinks were found, and where.

use super::deviation::Deviation;

/// A true kink and the one found for it, positions along the path of the clamp in m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KinkMatch {
    /// Where it is.
    pub truth: f64,
    /// Where it was found.
    pub found: f64,
}

impl KinkMatch {
    /// How far too large the position found is, m.
    pub fn error(&self) -> f64 {
        self.found - self.truth
    }
}

/// Kinks found against true ones: recall, precision, errors of position.
///
/// Scores of several scans are merged with [`merge`](Self::merge).
///
/// ```
/// use rod_reconstruct::score::KinkScore;
/// let score = KinkScore::of(&[0.010, 0.0305, 0.0600], &[0.0102, 0.0300], 1e-3);
/// assert_eq!((score.recall(), score.precision(), score.false_alarms()), (Some(1.0), Some(2.0 / 3.0), 1));
/// assert!((score.largest_error().unwrap_or(1.0) - 5e-4).abs() < 1e-12);
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct KinkScore {
    /// Number of true kinks.
    pub truth: usize,
    /// Number of kinks found.
    pub found: usize,
    /// Those of both that belong together, by growing distance within each scan.
    pub matches: Vec<KinkMatch>,
}

impl KinkScore {
    /// Kinks found at these positions against those that are there, in m (or any other unit, the same for all).
    ///
    /// Each is matched at most once: first the pair that is nearest, then the nearest of the rest, and so on, as long
    /// as they are at most `margin` apart. Of pairs equally far apart the one with the smaller true, then the smaller
    /// found position comes first, so that the order of the lists does not matter. Positions that are not finite match
    /// nothing.
    pub fn of(found: &[f64], truth: &[f64], margin: f64) -> Self {
        let mut pairs: Vec<(usize, usize)> = (0..truth.len())
            .flat_map(|i| (0..found.len()).map(move |j| (i, j)))
            .filter(|&(i, j)| (truth[i] - found[j]).abs() <= margin)
            .collect();
        pairs.sort_by(|&(i, j), &(k, l)| {
            let distance = |i: usize, j: usize| (truth[i] - found[j]).abs();
            let by_distance = distance(i, j).total_cmp(&distance(k, l));
            by_distance.then(truth[i].total_cmp(&truth[k])).then(found[j].total_cmp(&found[l]))
        });
        let (mut truth_left, mut found_left) = (vec![true; truth.len()], vec![true; found.len()]);
        let mut matches = Vec::new();
        for (i, j) in pairs {
            if truth_left[i] && found_left[j] {
                (truth_left[i], found_left[j]) = (false, false);
                matches.push(KinkMatch { truth: truth[i], found: found[j] });
            }
        }
        Self { truth: truth.len(), found: found.len(), matches }
    }

    /// Adds the kinks of another scan.
    pub fn merge(&mut self, other: &Self) {
        self.truth += other.truth;
        self.found += other.found;
        self.matches.extend_from_slice(&other.matches);
    }

    /// Number of kinks found that match no true one.
    pub fn false_alarms(&self) -> usize {
        self.found.saturating_sub(self.matches.len())
    }

    /// Share of the true kinks that were found; none where there are none.
    pub fn recall(&self) -> Option<f64> {
        share(self.matches.len(), self.truth)
    }

    /// Share of the kinks found that are true; none where none was found.
    pub fn precision(&self) -> Option<f64> {
        share(self.matches.len(), self.found)
    }

    /// Median of the absolute errors of position, m; none without matches.
    pub fn median_error(&self) -> Option<f64> {
        Deviation::of(self.matches.iter().map(KinkMatch::error)).map(|errors| errors.median)
    }

    /// Largest absolute error of position, m; none without matches.
    pub fn largest_error(&self) -> Option<f64> {
        Deviation::of(self.matches.iter().map(KinkMatch::error)).map(|errors| errors.largest)
    }
}

fn share(part: usize, whole: usize) -> Option<f64> {
    (whole > 0).then(|| part as f64 / whole as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_nearest_pair_is_matched_first_and_each_once() {
        // 1.2 is within the margin of both; 2.0 has a nearer one, and 1.0 keeps it.
        let score = KinkScore::of(&[1.9, 1.2], &[1.0, 2.0], 1.0);
        assert_eq!(score.matches, [KinkMatch { truth: 2.0, found: 1.9 }, KinkMatch { truth: 1.0, found: 1.2 }]);
        // Two near one true kink: one is a false alarm, and the other true one is missed.
        let score = KinkScore::of(&[1.0, 1.1], &[1.04, 9.0], 0.5);
        assert_eq!((score.matches.len(), score.false_alarms()), (1, 1));
        assert_eq!(score.matches[0].found, 1.0);
        assert_eq!((score.recall(), score.precision()), (Some(0.5), Some(0.5)));
    }

    #[test]
    fn the_margin_counts_as_within() {
        assert_eq!(KinkScore::of(&[1.5], &[1.0], 0.5).recall(), Some(1.0));
        assert_eq!(KinkScore::of(&[1.5], &[1.0], 0.4999).recall(), Some(0.0));
        assert!((KinkScore::of(&[1.5, 3.25], &[1.0, 3.0], 1.0).median_error().unwrap() - 0.375).abs() < 1e-15);
    }

    #[test]
    fn what_cannot_be_said_is_none() {
        let nothing = KinkScore::of(&[], &[], 1.0);
        assert_eq!((nothing.recall(), nothing.precision()), (None, None));
        assert_eq!((nothing.median_error(), nothing.largest_error()), (None, None));
        let missed = KinkScore::of(&[], &[1.0], 1.0);
        assert_eq!((missed.recall(), missed.precision()), (Some(0.0), None));
        let odd = KinkScore::of(&[f64::NAN, f64::INFINITY], &[1.0, f64::INFINITY], 1.0);
        assert_eq!((odd.recall(), odd.false_alarms(), odd.largest_error()), (Some(0.0), 2, None));
        assert_eq!(KinkScore::of(&[1.0], &[1.0], f64::NAN).recall(), Some(0.0));
    }

    proptest! {
        #[test]
        fn order_and_units_do_not_matter_and_the_truth_is_perfect(
            truth in prop::collection::vec(0..200_i32, 1..12), found in prop::collection::vec(0..200_i32, 0..12),
            margin in 0..20_i32, turn in 0..12_usize,
        ) {
            // Multiples of 1/8: distances without rounding, in both units.
            let places = |list: &[i32], unit: f64| list.iter().map(|k| unit * f64::from(*k)).collect::<Vec<_>>();
            let of = |found: &[i32], truth: &[i32], unit: f64| {
                KinkScore::of(&places(found, unit), &places(truth, unit), unit * f64::from(margin))
            };
            let score = of(&found, &truth, 0.125);
            prop_assert!(score.matches.iter().all(|pair| pair.error().abs() <= 0.125 * f64::from(margin)));
            prop_assert!(score.matches.len() <= truth.len().min(found.len()));
            let (mut turned, mut reversed) = (truth.clone(), found.clone());
            turned.rotate_left(turn % truth.len());
            reversed.reverse();
            prop_assert_eq!(&of(&reversed, &turned, 0.125), &score);
            let scaled = of(&found, &truth, 1.0);
            prop_assert_eq!((scaled.recall(), scaled.precision()), (score.recall(), score.precision()));
            let perfect = of(&truth, &truth, 0.125);
            prop_assert_eq!((perfect.recall(), perfect.precision()), (Some(1.0), Some(1.0)));
            prop_assert_eq!(perfect.largest_error(), Some(0.0));
            let mut twice = score.clone();
            twice.merge(&score);
            prop_assert_eq!((twice.recall(), twice.precision()), (score.recall(), score.precision()));
            prop_assert_eq!(twice.false_alarms(), 2 * score.false_alarms());
        }
    }
}
