//! Medians, which a few wild values do not move.

/// Median of |z| of a standard normal variable z.
const NORMAL_MEDIAN: f64 = 0.6745;

/// The median, the upper one of an even number; none without values.
pub(crate) fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_unstable_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

/// The standard deviation about 0 of normal variables, from the median of their sizes; none without values.
pub(crate) fn robust_sigma(values: impl Iterator<Item = f64>) -> Option<f64> {
    median(values.map(f64::abs).collect()).map(|median| median / NORMAL_MEDIAN)
}
