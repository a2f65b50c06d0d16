//! The steps of a channel of few digits.

/// The median of the lengths of groups; 1 without any. Half of the groups, not of what is in them: one group may hold most.
pub(super) fn usual(lengths: impl Iterator<Item = usize>) -> usize {
    let mut lengths: Vec<usize> = lengths.collect();
    let middle = lengths.len() / 2;
    if lengths.is_empty() { 1 } else { *lengths.select_nth_unstable(middle).1 }
}

/// Longest time (samples) for which a value counts as held. Larger: a channel that rests for long is taken for one with coarser means
/// than it has.
const LONGEST: usize = 1024;

/// The quantum of a channel: the smallest difference of neighbours, where at least a third of the neighbours are equal and the
/// others differ by multiples of it.
pub(crate) fn quantum(channel: &[f64]) -> Option<f64> {
    let steps = || channel.windows(2).map(|w| (w[1] - w[0]).abs()).filter(|d| d.is_finite());
    let (equal, all) = steps().fold((0, 0), |(e, n), d| (e + usize::from(d == 0.0), n + 1));
    if 3 * equal < all || equal == all {
        return None;
    }
    let smallest = steps().filter(|d| *d > 0.0).fold(f64::INFINITY, f64::min);
    let multiple = |d: f64| (d / smallest - (d / smallest).round()).abs() < 1e-3 * (d / smallest).max(1.0);
    let odd = steps().filter(|d| *d > 0.0 && !multiple(*d)).count();
    (20 * odd < all - equal).then_some(smallest)
}

/// Number of samples for which a value is held: half of the samples belong to longer runs of equal values.
pub(super) fn hold_length(channel: &[f64]) -> usize {
    let mut runs: Vec<usize> = channel.chunk_by(|a, b| a == b).map(<[f64]>::len).collect();
    runs.sort_unstable();
    let mut passed = 0;
    let middle = runs.iter().find(|run| {
        passed += **run;
        2 * passed >= channel.len()
    });
    middle.map_or(1, |run| (*run).min(LONGEST))
}
