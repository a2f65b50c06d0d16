//! The phases of a whole scan.

use super::border::border;
use super::evidence::Evidence;
use super::trellis::{Break, Place, Trellis};
use crate::phase::label::Label;
use crate::scan::local_cubic::{Fit, Noise};
use crate::scan::track::Track;
use std::ops::Range;

/// A cubic has four coefficients: a window tells about three independent rates.
const INDEPENDENT: f64 = 3.0;
/// Places to a window.
const PLACES: usize = 8;
/// Most samples on one side of a place.
const WIDEST: usize = 2000;

/// What a scan says at one place.
#[derive(Clone, Debug)]
pub(crate) struct Node {
    pub index: usize,
    pub fit: Fit,
    pub evidence: Evidence,
    pub place: Place,
}

impl Node {
    /// About a sample, from samples of `part` only, at most `widest` on one side; none where these are too few.
    pub fn about(track: &Track, index: usize, part: Range<usize>, noise: &Noise, widest: usize) -> Option<Self> {
        let fit = Fit::about(track, index, part, noise, widest)?;
        let evidence = Evidence::of(&fit.at(track.tau[index]));
        Some(Self { index, fit, evidence, place: Place { scores: [0.0; 5], between: None } })
    }

    /// As one of places `stride` samples apart, with what lies before it. Windows that overlap tell the same thing
    /// several times: each counts for its part.
    pub fn placed(self, stride: usize, between: Option<Break>) -> Self {
        let weight = (INDEPENDENT * stride as f64 / self.fit.window.len() as f64).min(1.0);
        let place = Place { scores: self.evidence.scores().map(|score| weight * score), between };
        Self { place, ..self }
    }
}

/// The label of each sample, how sure it is, and what decided.
#[derive(Clone, Debug)]
pub(crate) struct Identified {
    pub nodes: Vec<Node>,
    /// Runs of one label, in order, without gaps.
    pub runs: Vec<(Range<usize>, Label)>,
    /// Of each node.
    pub labels: Vec<(Label, f64)>,
}

/// The parts between breaks.
fn parts(samples: usize, breaks: &[Break]) -> Vec<(Range<usize>, Option<Break>)> {
    let mut parts = Vec::with_capacity(breaks.len() + 1);
    let (mut start, mut before) = (0, None);
    for &here in breaks {
        if here.index > start && here.index < samples {
            parts.push((start..here.index, before));
            (start, before) = (here.index, Some(here));
        }
    }
    parts.push((start..samples, before));
    parts
}

/// Finds the phases of a scan that may break where `breaks` say.
pub(crate) fn identify(track: &Track, noise: &Noise, breaks: &[Break]) -> Identified {
    let mut nodes = Vec::new();
    for (part, before) in parts(track.tau.len(), breaks) {
        let mut between = before;
        let mut index = part.start;
        // too few samples between two breaks go with what is around them
        while let Some(node) = Node::about(track, index, part.clone(), noise, WIDEST) {
            let stride = (node.fit.window.len() / PLACES).max(1);
            nodes.push(node.placed(stride, between.take()));
            if index + 1 >= part.end {
                break;
            }
            index = (index + stride).min(part.end - 1);
        }
    }
    let labels = Trellis::default().run(&[0.0; 5], nodes.iter().map(|node| node.place)).to_vec();
    let runs = runs(track, noise, &nodes, &labels);
    Identified { nodes, runs, labels }
}

/// Runs of one label: they change at a break, or, between A and B, where the samples themselves say.
fn runs(track: &Track, noise: &Noise, nodes: &[Node], labels: &[(Label, f64)]) -> Vec<(Range<usize>, Label)> {
    let mut runs: Vec<(Range<usize>, Label)> = Vec::new();
    let mut start = 0;
    for k in 1..nodes.len() {
        let (before, after) = (labels[k - 1].0, labels[k].0);
        if before == after {
            continue;
        }
        let border = match nodes[k].place.between {
            Some(here) => here.index,
            None => {
                // the window of the fit reaches over the change: look further than its two places
                let reach = nodes[k].fit.window.len();
                let from = nodes[k - 1].index.saturating_sub(reach).max(start);
                let to = (nodes[k].index + reach).min(track.tau.len());
                let stop = nodes[k..].iter().find(|node| node.place.between.is_some()).map_or(to, |node| node.index);
                border(track, noise, from..to.min(stop), before == Label::A)
            }
        };
        runs.push((start..border, before));
        start = border;
    }
    let last = labels.last().map_or(Label::Free, |label| label.0);
    runs.push((start..track.tau.len(), last));
    runs
}
