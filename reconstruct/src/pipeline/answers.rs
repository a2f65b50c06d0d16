//! The answers to the samples of a scan whose phases are known.

use super::nearest::Nearest;
use super::reading::{Reading, Reason, sure};
use super::settings::Settings;
use super::torn::torn;
use crate::kink::Kink;
use crate::phase::{Break, Identified, Label, contact};
use crate::point::{Inverse, Touch};
use crate::scan::{Noise, Track};
use crate::systematic::Shared;
use crate::two_contacts::{Around, Limits, Neighbour, Passed, Piece, Unresolved, resolve};
use nalgebra::Matrix2;
use rod_core::Units;
use std::ops::Range;

/// Samples at the border of two phases that are left out, besides those within the uncertainty of its kink.
const MARGIN: usize = 3;
/// The uncertainty of a kink in its standard deviations, which are rather too small: the curvature breaks at a kink, too.
const SIGMAS: f64 = 4.0;
/// Largest standard deviation of one of several contacts across the contour, in rod lengths.
const ACROSS: f64 = 5e-3;

/// Standard deviations by which a criterion may contradict the phase of a single contact: as many as a contact point may be off.
const CONTRADICTED: f64 = 6.0;

/// Whether the reactions jump before this sample.
fn jumps(breaks: &[Break], index: usize) -> bool {
    breaks.iter().any(|here| here.jump && here.index == index)
}

/// What the answers to the samples of a scan are computed from.
pub(super) struct Answers<'a, I> {
    pub rod: &'a I,
    pub track: &'a Track,
    pub kinks: &'a [Kink],
    pub noise: &'a Noise,
    pub identified: &'a Identified,
    pub units: Units,
    pub settings: &'a Settings,
    /// The errors that all samples share, if there are any.
    pub shared: Option<&'a Shared>,
    /// For each place the covariance that they cause of a single contact point there, dimensionless, if it is known; empty without them.
    pub systematic: &'a [Option<Matrix2<f64>>],
}

impl<I: Inverse> Answers<'_, I> {
    /// The answers to all usable samples.
    pub fn all(&self, breaks: &[Break]) -> Vec<Reading> {
        let mut readings = Vec::with_capacity(self.track.len());
        let runs = &self.identified.runs;
        let mut next = 0;
        while next < runs.len() {
            if runs[next].1.several() {
                let many = runs[next..].iter().take_while(|run| run.1.several()).count();
                self.several(next..next + many, breaks, &mut readings);
                next += many;
            } else {
                let (range, label) = runs[next].clone();
                let mut nodes = Nearest::new(self.identified, label, range.start);
                readings.extend(range.map(|index| self.single(&mut nodes, index, label)));
                next += 1;
            }
        }
        readings
    }

    /// The reading of a sample, with the probability of the nearest place of its label.
    fn reading(&self, nodes: &mut Nearest<'_>, index: usize, label: Label, touch: Result<Touch, Reason>) -> Reading {
        let place = nodes.of(index);
        let probability = match self.identified.labels[place] {
            (found, probability) if found == label => probability,
            _ => 0.0,
        };
        Reading { label, probability, touch, second: None, place }
    }

    /// The answer to a sample with one contact or none.
    fn single(&self, nodes: &mut Nearest<'_>, index: usize, label: Label) -> Reading {
        let place = nodes.of(index);
        let node = &self.identified.nodes[place];
        if let Some((criterion, z)) = node.evidence.against(label).filter(|(_, z)| *z > CONTRADICTED) {
            return self.reading(nodes, index, label, Err(Reason::Contradicted { criterion, z }));
        }
        if label == Label::Free {
            return self.reading(nodes, index, label, Err(Reason::Free));
        }
        let fit = &node.fit;
        let touch = contact(self.rod, &self.track.clamps[index], self.track.tau[index], fit, self.noise, label);
        let systematic = match self.systematic.get(place) {
            Some(None) => return self.reading(nodes, index, label, Err(Reason::Unshared)),
            Some(Some(found)) => *found,
            None => Matrix2::zeros(),
        };
        let touch = touch.map_err(Reason::NoContact).and_then(|touch| self.sure(touch.with_systematic(systematic)));
        self.reading(nodes, index, label, touch)
    }

    /// The point in SI units, if it is known well enough.
    fn sure(&self, touch: Touch) -> Result<Touch, Reason> {
        sure(touch, self.units, self.settings.largest_sigma, self.noise.is_clean())
    }

    /// By how many samples a border may be misplaced: by the uncertainty of its kink.
    fn unsure(&self, border: usize) -> usize {
        let track = self.track;
        let kink = self.kinks.iter().find(|kink| kink.next == border);
        let sigma = kink.map_or(0.0, |kink| SIGMAS * kink.sigma_tau);
        let from = track.tau.get(border).map_or(border, |tau| track.tau.partition_point(|other| *other < tau - sigma));
        (border - from.min(border)).min(track.len())
    }

    /// The answers to consecutive runs with several contacts. They are resolved in parts between jumps, and between kinks within a phase,
    /// after which other contacts may be the first and the last.
    fn several(&self, consecutive: Range<usize>, breaks: &[Break], readings: &mut Vec<Reading>) {
        let runs = &self.identified.runs;
        let single = |label: Label| label != Label::Free && !label.several();
        let neighbour = |index: Option<usize>| {
            let (range, label) = runs.get(index?).filter(|run| single(run.1))?;
            Some(Neighbour { range: range.clone(), label: *label })
        };
        let mut before =
            neighbour(consecutive.start.checked_sub(1)).filter(|_| !jumps(breaks, runs[consecutive.start].0.start));
        let mut pieces: Vec<Piece> = Vec::new();
        let from = readings.len();
        // the numbers of readings at which parts begin, and whether the reactions jump there
        let mut parts: Vec<(usize, bool)> = vec![(from, true)];
        for (range, label) in &runs[consecutive.clone()] {
            let inside = breaks.iter().filter(|here| range.start < here.index && here.index < range.end);
            let mut start = range.start;
            for end in inside.map(|here| here.index).chain([range.end]) {
                if start > range.start || jumps(breaks, start) && !pieces.is_empty() {
                    self.resolved(std::mem::take(&mut pieces), [before.take(), None], breaks, readings);
                    parts.push((readings.len(), jumps(breaks, start)));
                }
                pieces.push(Piece { range: start..end, label: *label });
                start = end;
            }
        }
        let after = neighbour(Some(consecutive.end)).filter(|_| !jumps(breaks, runs[consecutive.end - 1].0.end));
        self.resolved(pieces, [before, after], breaks, readings);
        self.doubt_torn(runs[consecutive.start].0.start, &parts, readings);
    }

    /// Takes back the answers to neighbouring parts, the first of which starts at sample `start`, that contradict each other.
    fn doubt_torn(&self, start: usize, parts: &[(usize, bool)], readings: &mut [Reading]) {
        let Some(&(from, _)) = parts.first() else { return };
        let tau = &self.track.tau[start..];
        let ends = parts.iter().skip(1).map(|part| part.0).chain([readings.len()]);
        let ranges: Vec<Range<usize>> = parts.iter().zip(ends).map(|(part, end)| part.0..end).collect();
        let several = &readings[from..];
        let torn: Vec<usize> =
            (1..parts.len()).filter(|&k| !parts[k].1 && torn(several, tau, parts[k].0 - from, self.units)).collect();
        for k in torn.into_iter().flat_map(|k| [k - 1, k]) {
            for reading in &mut readings[ranges[k].clone()] {
                let reason = Reason::Several(Unresolved::Torn);
                *reading = Reading { touch: Err(reason), second: Some(Err(reason)), ..*reading };
            }
        }
    }

    /// The shapes of the rod on both sides of these pieces, up to where they are not known or jump.
    fn passed(&self, pieces: &[Piece], breaks: &[Break]) -> Passed {
        let (Some(first), Some(last)) = (pieces.first(), pieces.last()) else { return Passed::default() };
        let Identified { nodes, labels, .. } = self.identified;
        let (start, end) = (first.range.start, last.range.end);
        let to = nodes.partition_point(|node| node.index < start);
        let from = nodes.partition_point(|node| node.index < end);
        // the jumps next to the pieces are none of those beyond them
        let jumps = || breaks.iter().filter(|here| here.jump).map(|here| here.index);
        let least = jumps().rfind(|index| *index < start).unwrap_or(0);
        let most = jumps().find(|index| *index > end).unwrap_or(self.track.len());
        let known = |k: &usize| !labels[*k].0.several() && (least..most).contains(&nodes[*k].index);
        let clamp = |k: usize| (nodes[k].fit.at(self.track.tau[nodes[k].index]).clamp, labels[k].0);
        let before = (0..to).rev().take_while(known).map(clamp).collect();
        let after = (from..nodes.len()).take_while(known).map(clamp).collect();
        Passed::new(self.rod, [before, after])
    }

    /// The answers to pieces that are joined without a jump.
    fn resolved(
        &self,
        pieces: Vec<Piece>,
        [before, after]: [Option<Neighbour>; 2],
        breaks: &[Break],
        readings: &mut Vec<Reading>,
    ) {
        let borders = pieces.iter().flat_map(|piece| [piece.range.start, piece.range.end]);
        let margin = borders.map(|border| self.unsure(border)).max().unwrap_or(0) + MARGIN;
        let limits = Limits { across: self.settings.largest_sigma.min(ACROSS), margin, ..Limits::default() };
        let displacements = match (self.shared, pieces.first(), pieces.last()) {
            (Some(shared), Some(first), Some(last)) => {
                let stretch = first.range.start..last.range.end;
                shared.displacements(self.track, &self.identified.nodes, &stretch)
            }
            _ => Vec::new(),
        };
        let around = Around { neighbours: [before.as_ref(), after.as_ref()], passed: &self.passed(&pieces, breaks) };
        let pairs = resolve(self.rod, self.track, self.noise, &pieces, around, &limits, &displacements);
        let sure = |found: Result<Touch, Unresolved>| match found {
            Ok(touch) => self.sure(touch),
            Err(Unresolved::TooNoisy { sigma }) => Err(Reason::TooNoisy { sigma: sigma * self.units.length }),
            Err(reason) => Err(Reason::Several(reason)),
        };
        let mut pairs = pairs.into_iter();
        for Piece { range, label } in pieces {
            let mut nodes = Nearest::new(self.identified, label, range.start);
            for (index, pair) in range.zip(pairs.by_ref()) {
                let reading = self.reading(&mut nodes, index, label, sure(pair.first));
                readings.push(Reading { second: Some(sure(pair.second)), ..reading });
            }
        }
    }
}
