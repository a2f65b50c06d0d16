//! Parts of a line.

/// Intervals of a line (m) that do not overlap, in order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct IntervalSet {
    parts: Vec<(f64, f64)>,
}

impl IntervalSet {
    /// One interval.
    pub fn of(from: f64, to: f64) -> Self {
        let mut set = Self::default();
        set.insert(from, to);
        set
    }

    /// The intervals in order.
    pub fn parts(&self) -> &[(f64, f64)] {
        &self.parts
    }

    /// Sum of the lengths, m.
    pub fn length(&self) -> f64 {
        // a sum of nothing is -0
        0.0 + self.parts.iter().map(|(from, to)| to - from).sum::<f64>()
    }

    /// Whether a place is in one of the intervals, ends included.
    pub fn contains(&self, place: f64) -> bool {
        let later = self.parts.partition_point(|part| part.0 <= place);
        later > 0 && place <= self.parts[later - 1].1
    }

    /// Adds an interval; one without length adds nothing.
    pub fn insert(&mut self, from: f64, to: f64) {
        if from >= to || from.is_nan() || to.is_nan() {
            return;
        }
        let first = self.parts.partition_point(|part| part.1 < from);
        let last = self.parts.partition_point(|part| part.0 <= to);
        let merged =
            self.parts[first..last].iter().fold((from, to), |(from, to), part| (from.min(part.0), to.max(part.1)));
        self.parts.splice(first..last, [merged]);
    }

    /// Adds all intervals of another set.
    pub fn extend(&mut self, other: &Self) {
        other.parts.iter().for_each(|(from, to)| self.insert(*from, *to));
    }

    /// What of this set is not in the other.
    #[must_use]
    pub fn without(&self, other: &Self) -> Self {
        let mut left = Self::default();
        for &(from, to) in &self.parts {
            let mut rest = from;
            for part in other.parts.iter().filter(|part| part.1 > from && part.0 < to) {
                left.insert(rest, part.0);
                rest = rest.max(part.1);
            }
            left.insert(rest, to);
        }
        left
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_that_meet_are_one() {
        let mut set = IntervalSet::of(2.0, 3.0);
        set.insert(5.0, 6.0);
        set.insert(0.0, 1.0);
        assert_eq!(set.parts(), [(0.0, 1.0), (2.0, 3.0), (5.0, 6.0)]);
        set.insert(3.0, 5.5);
        assert_eq!(set.parts(), [(0.0, 1.0), (2.0, 6.0)]);
        set.insert(4.0, 4.0);
        assert_eq!(set.length(), 5.0);
        assert!(set.contains(6.0) && set.contains(0.0) && !set.contains(1.5) && !set.contains(-0.1));
    }

    #[test]
    fn the_rest_is_what_another_set_leaves() {
        let mut other = IntervalSet::of(1.0, 2.0);
        other.insert(3.0, 9.0);
        assert_eq!(IntervalSet::of(0.0, 4.0).without(&other).parts(), [(0.0, 1.0), (2.0, 3.0)]);
        assert_eq!(IntervalSet::of(1.5, 1.6).without(&other).length(), 0.0);
        assert_eq!(other.without(&IntervalSet::default()), other);
    }
}
