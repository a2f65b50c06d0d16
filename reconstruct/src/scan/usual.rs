//! The usual length of groups.

/// The median of the lengths of groups; 1 without any. Half of the groups, not of what is in them: one group may hold most.
pub(super) fn usual(lengths: impl Iterator<Item = usize>) -> usize {
    let mut lengths: Vec<usize> = lengths.collect();
    let middle = lengths.len() / 2;
    if lengths.is_empty() { 1 } else { *lengths.select_nth_unstable(middle).1 }
}
