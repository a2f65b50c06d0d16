//! Places where a transition may be, in the order in which they are tried.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// A node and its score over threshold.
#[derive(Clone, Copy, Debug)]
struct ScoredNode {
    ratio: f64,
    node: usize,
}

impl PartialEq for ScoredNode {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for ScoredNode {}

impl PartialOrd for ScoredNode {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for ScoredNode {
    fn cmp(&self, other: &Self) -> Ordering {
        self.ratio.total_cmp(&other.ratio).then(self.node.cmp(&other.node))
    }
}

/// The candidates of a scale: returns the best, and takes other ratios where a transition was found nearby.
#[derive(Clone, Debug, Default)]
pub(super) struct Candidates {
    /// In order of nodes; the ratio is NaN where it is done with.
    all: Vec<ScoredNode>,
    /// The best first. Entries whose ratio has changed are passed over.
    queue: BinaryHeap<ScoredNode>,
}

impl Candidates {
    /// Room for as many candidates without allocation.
    pub fn reserve(&mut self, capacity: usize) {
        self.all.reserve(capacity);
        self.queue.reserve(2 * capacity);
    }

    pub fn clear(&mut self) {
        self.all.clear();
        self.queue.clear();
    }

    /// Takes a node that follows all others.
    pub fn push(&mut self, ratio: f64, node: usize) {
        self.all.push(ScoredNode { ratio, node });
        self.queue.push(ScoredNode { ratio, node });
    }

    /// Takes off the node with the largest ratio.
    pub fn pop(&mut self) -> Option<(f64, usize)> {
        while let Some(best) = self.queue.pop() {
            let at = self.all.partition_point(|candidate| candidate.node < best.node);
            if self.all[at] == best {
                self.all[at].ratio = f64::NAN;
                return Some((best.ratio, best.node));
            }
        }
        None
    }

    /// Gives nodes `low..=high` other ratios; none for those that are not candidates any more.
    pub fn update(&mut self, (low, high): (usize, usize), ratio: impl Fn(usize) -> Option<f64>) {
        let from = self.all.partition_point(|candidate| candidate.node < low);
        let to = self.all.partition_point(|candidate| candidate.node <= high);
        for at in from..to {
            let old = self.all[at];
            let new = ScoredNode { ratio: ratio(old.node).unwrap_or(f64::NAN), ..old };
            if old.ratio.is_nan() || new == old {
                continue;
            }
            self.all[at] = new;
            if self.queue.len() == self.queue.capacity() {
                let all = &self.all;
                self.queue.retain(|entry| all[all.partition_point(|other| other.node < entry.node)] == *entry);
            }
            if !new.ratio.is_nan() {
                self.queue.push(new);
            }
        }
    }
}
