//! The answers to samples with several contacts.

use super::answers::{Answers, NearestPlace};
use super::reading::{Reading, Reason};
use crate::phase::{Break, Label};
use crate::point::{Inverse, Touch};
use crate::scan::TrackIndex;
use crate::two_contacts::{Limits, Neighbour, Piece, Resolution, Unresolved, resolve};
use std::ops::Range;

/// Samples at the border of two phases that are left out, besides those within the uncertainty of its kink.
const MARGIN: usize = 3;
/// The uncertainty of a kink in its standard deviations, which are rather too small: the curvature breaks at a kink, too.
const SIGMAS: f64 = 4.0;
/// Largest standard deviation of one of several contacts across the contour, in rod lengths.
const ACROSS: f64 = 5e-3;

/// Whether the reactions jump before this sample.
fn jumps(breaks: &[Break], index: usize) -> bool {
    breaks.iter().any(|here| here.jump && here.index == index)
}

/// Pieces that are resolved together, and what came of it.
#[derive(Clone, Debug)]
pub(super) struct Together {
    pub pieces: Vec<Piece>,
    pub found: Resolution,
}

impl<I: Inverse> Answers<'_, I> {
    /// The answers to consecutive runs with several contacts. They are resolved in parts between jumps, and between kinks within a phase,
    /// after which other contacts may be the first and the last.
    pub(super) fn several(&self, consecutive: Range<usize>, breaks: &[Break], readings: &mut Vec<Reading>) {
        let runs = &self.phases.runs;
        let single = |label: Label| label != Label::Free && !label.several();
        let neighbour = |index: Option<usize>| {
            let (range, label) = runs.get(index?).filter(|run| single(run.1))?;
            Some(Neighbour { range: range.clone(), label: *label })
        };
        let start = runs[consecutive.start].0.start;
        let before = neighbour(consecutive.start.checked_sub(1)).filter(|_| !jumps(breaks, start));
        let after = neighbour(Some(consecutive.end)).filter(|_| !jumps(breaks, runs[consecutive.end - 1].0.end));
        let mut pieces: Vec<Piece> = Vec::new();
        for (range, label) in &runs[consecutive] {
            let inside = breaks.iter().filter(|here| range.start < here.index && here.index < range.end);
            let mut start = range.start;
            for end in inside.map(|here| here.index).chain([range.end]) {
                pieces.push(Piece { range: start..end, label: *label });
                start = end;
            }
        }
        let smooth: Vec<&[Piece]> = pieces.chunk_by(|_, next| !jumps(breaks, next.range.start)).collect();
        for (k, pieces) in smooth.iter().enumerate() {
            let beside = [before.as_ref().filter(|_| k == 0), after.as_ref().filter(|_| k + 1 == smooth.len())];
            let resolved =
                if self.rod.tells_last() { self.as_labelled(pieces, beside) } else { self.tell_apart(pieces, beside) };
            for together in resolved {
                self.read(together, readings);
            }
        }
    }

    /// Pieces without jumps in between, resolved as the phases label them. A kink within a phase divides them.
    fn as_labelled(&self, pieces: &[Piece], beside: [Option<&Neighbour>; 2]) -> Vec<Together> {
        let parts: Vec<&[Piece]> = pieces.chunk_by(|piece, next| piece.label != next.label).collect();
        let resolved = |k: usize| {
            let here = [beside[0].filter(|_| k == 0), beside[1].filter(|_| k + 1 == parts.len())];
            self.together(parts[k].to_vec(), here)
        };
        (0..parts.len()).map(resolved).collect()
    }

    /// By how many samples a border may be misplaced: by the uncertainty of its kink.
    fn unsure(&self, border: usize) -> usize {
        let track = self.track;
        let kink = self.kinks.iter().find(|kink| kink.next == border);
        let sigma = kink.map_or(0.0, |kink| SIGMAS * kink.sigma_tau);
        let from = track.tau.get(border).map_or(border, |tau| track.tau.partition_point(|other| *other < tau - sigma));
        (border - from.min(border)).min(track.len())
    }

    /// Pieces that are joined without a jump, resolved with what is beside them.
    pub(super) fn together(&self, pieces: Vec<Piece>, neighbours: [Option<&Neighbour>; 2]) -> Together {
        let borders = pieces.iter().flat_map(|piece| [piece.range.start, piece.range.end]);
        let margin = borders.map(|border| self.unsure(border)).max().unwrap_or(0) + MARGIN;
        let limits = Limits { across: self.settings.largest_sigma.min(ACROSS), margin, ..Limits::default() };
        let displacements = match (self.shared, pieces.first(), pieces.last()) {
            (Some(shared), Some(first), Some(last)) => {
                let stretch = first.range.start..last.range.end;
                shared.displacements(self.track, &self.phases.places, &stretch)
            }
            _ => Vec::new(),
        };
        let found = resolve(self.rod, self.track, self.noise, &pieces, neighbours, &limits, &displacements);
        Together { pieces, found }
    }

    /// The readings of pieces, appended.
    fn read(&self, Together { pieces, found }: Together, readings: &mut Vec<Reading>) {
        let sure = |found: Result<Touch, Unresolved>| match found {
            Ok(touch) => self.sure(touch),
            Err(Unresolved::TooNoisy { sigma }) => Err(Reason::TooNoisy { sigma: sigma * self.units.length }),
            Err(reason) => Err(Reason::Several(reason)),
        };
        let mut pairs = found.pairs.into_iter();
        for Piece { range, label } in pieces {
            // that of the phases, by which the places are found
            let given = self.phases.runs.iter().find(|run| run.0.contains(&range.start)).map_or(label, |run| run.1);
            let mut nearest = NearestPlace::new(self.phases, given, range.start);
            for (index, pair) in range.zip(pairs.by_ref()) {
                let reading = self.reading(&mut nearest, TrackIndex(index), given, sure(pair.first));
                readings.push(Reading { label, second: Some(sure(pair.second)), ..reading });
            }
        }
    }
}
