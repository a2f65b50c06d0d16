//! The phases of a whole scan.

use super::border::border;
use super::diagram::Break;
use super::evidence::Evidence;
use super::label::Label;
use super::trellis::{Place, Trellis, forward};
use crate::point::Inverse;
use crate::scan::{LocalCubic, Noise, Track};
use std::ops::Range;

/// Independent values of the evidence in a window: a cubic has four coefficients, hence three rates.
const INDEPENDENT: f64 = 3.0;
/// Places per window.
const PLACES: usize = 8;
/// Most samples of a window on one side of a place. Larger: less noise in slow scans, and more time.
const WIDEST: usize = 2000;

/// A place of a scan with the fit about it and its evidence.
#[derive(Clone, Debug)]
pub(crate) struct Node {
    pub index: usize,
    pub fit: LocalCubic,
    pub evidence: Evidence,
    /// Its share of the samples of its window, which overlaps those of its neighbours.
    pub weight: f64,
    pub place: Place,
}

impl Node {
    /// At a sample, from samples of `part` only, at most `widest` on one side; none where these are too few.
    pub fn about<I: Inverse>(
        rod: &I,
        track: &Track,
        index: usize,
        part: Range<usize>,
        noise: &Noise,
        widest: usize,
    ) -> Option<Self> {
        let fit = LocalCubic::about(track, index, part, noise, widest)?;
        let evidence = Evidence::of(rod, &fit.at(track.tau[index]));
        Some(Self { index, fit, evidence, weight: 1.0, place: Place { scores: [0.0; 5], between: None } })
    }

    /// As one of places that are `stride` samples apart, with the break before it. Overlapping windows contain the same samples: each
    /// counts with its share.
    pub fn placed(self, stride: usize, between: Option<Break>) -> Self {
        let weight = (INDEPENDENT * stride as f64 / self.fit.window.len() as f64).min(1.0);
        let place = Place { scores: self.evidence.scores().map(|score| weight * score), between };
        Self { place, weight, ..self }
    }

    /// With other evidence.
    pub fn judged(&mut self, evidence: Evidence) {
        self.place.scores = evidence.scores().map(|score| self.weight * score);
        self.evidence = evidence;
    }
}

/// The labels of a scan.
#[derive(Clone, Debug)]
pub(crate) struct Identified {
    pub nodes: Vec<Node>,
    /// Runs of samples with one label, in order, without gaps.
    pub runs: Vec<(Range<usize>, Label)>,
    /// The label of each node and its probability.
    pub labels: Vec<(Label, f64)>,
}

/// The parts between breaks.
pub(crate) fn parts(samples: usize, breaks: &[Break]) -> Vec<(Range<usize>, Option<Break>)> {
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

/// The places of a scan whose reactions break at `breaks`.
pub(crate) fn places<I: Inverse>(rod: &I, track: &Track, noise: &Noise, breaks: &[Break]) -> Vec<Node> {
    let mut nodes = Vec::new();
    for (part, before) in parts(track.tau.len(), breaks) {
        let mut between = before;
        let mut index = part.start;
        // a part with too few samples for a fit has no node, and takes the label of its neighbours
        while let Some(node) = Node::about(rod, track, index, part.clone(), noise, WIDEST) {
            let stride = (node.fit.window.len() / PLACES).max(1);
            nodes.push(node.placed(stride, between.take()));
            if index + 1 >= part.end {
                break;
            }
            index = (index + stride).min(part.end - 1);
        }
    }
    nodes
}

/// The label of each place and its probability, of several contacts that of BA and BB together where they are `alike`.
pub(crate) fn labels(nodes: &[Node], alike: bool) -> Vec<(Label, f64)> {
    let mut trellis = if alike { Trellis::alike() } else { Trellis::default() };
    trellis.run(&[0.0; 5], nodes.iter().map(|node| node.place)).to_vec()
}

/// Log of the likelihood of the most likely labels.
pub(crate) fn likelihood(nodes: &[Node]) -> f64 {
    let last = nodes.iter().fold([0.0; 5], |before, node| forward(&before, &node.place).0);
    last.into_iter().fold(f64::NEG_INFINITY, f64::max)
}

/// The phases of a scan with these places.
pub(crate) fn identify<I: Inverse>(rod: &I, track: &Track, noise: &Noise, nodes: Vec<Node>) -> Identified {
    let labels = labels(&nodes, !rod.tells_last());
    let runs = runs(rod, track, noise, &nodes, &labels);
    Identified { nodes, runs, labels }
}

/// Runs of one label. They end at breaks, or, between A and B, at the border that fits the samples best.
fn runs<I: Inverse>(
    rod: &I,
    track: &Track,
    noise: &Noise,
    nodes: &[Node],
    labels: &[(Label, f64)],
) -> Vec<(Range<usize>, Label)> {
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
                // the window of the fit may reach across the border: search beyond the two places
                let reach = nodes[k].fit.window.len();
                let from = nodes[k - 1].index.saturating_sub(reach).max(start);
                let to = (nodes[k].index + reach).min(track.tau.len());
                let stop = nodes[k..].iter().find(|node| node.place.between.is_some()).map_or(to, |node| node.index);
                border(rod, track, noise, from..to.min(stop), before == Label::A)
            }
        };
        runs.push((start..border, before));
        start = border;
    }
    let last = labels.last().map_or(Label::Free, |label| label.0);
    runs.push((start..track.tau.len(), last));
    runs
}
