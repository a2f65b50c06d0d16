//! The nearest place of a scan with a label.

use crate::phase::{Identified, Label};

/// Finds the nearest place with a label, for samples in order.
pub(super) struct Nearest<'a> {
    identified: &'a Identified,
    label: Label,
    at: usize,
}

impl<'a> Nearest<'a> {
    /// For samples from `start` on.
    pub fn new(identified: &'a Identified, label: Label, start: usize) -> Self {
        let nodes = &identified.nodes;
        let at = nodes.partition_point(|node| node.index < start).min(nodes.len().saturating_sub(1));
        Self { identified, label, at }
    }

    /// The index of the place that is nearest to a sample.
    pub fn of(&mut self, index: usize) -> usize {
        let (nodes, labels) = (&self.identified.nodes, &self.identified.labels);
        let off = |at: usize| (labels[at].0 != self.label, nodes[at].index.abs_diff(index));
        // places of other labels may lie between: go on to the sample
        let mut look = self.at;
        while look + 1 < nodes.len() && nodes[look].index <= index {
            look += 1;
            if off(look) < off(self.at) {
                self.at = look;
            }
        }
        self.at
    }
}
