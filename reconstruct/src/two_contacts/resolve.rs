//! Stretches with several contacts, resolved.

use super::displaced::displaced;
use super::pair::{Limits, Pair, answer};
use super::run::solve;
use super::series::Series;
use super::single::Single;
use super::unresolved::Unresolved;
use crate::phase::Label;
use crate::point::Inverse;
use crate::scan::{Noise, Track};
use crate::systematic::Correction;
use std::ops::Range;

/// Fewest samples of a stretch: fewer do not determine rates.
const FEWEST_SAMPLES: usize = 16;
/// One of so many samples of a stretch is left out at an end where no contact is known to go on, of a rod with joints: the first contact may
/// pass one there, beyond which the conditions are others. Larger: the least squares do not find a way past it; smaller: less of the
/// stretch is used.
const PASSES_JOINT: usize = 24;

/// A stretch with several contacts.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Piece {
    pub range: Range<usize>,
    pub label: Label,
}

/// A stretch with one contact beside a run, without a jump in between.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Neighbour {
    pub range: Range<usize>,
    pub label: Label,
}

/// Both contacts of each sample of a run, and how well they explain it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Resolution {
    pub pairs: Vec<Pair>,
    /// Samples that no two contacts explain.
    pub unexplained: usize,
    /// Sum of the weighted squares of what explains the others.
    pub cost: f64,
}

impl Resolution {
    /// Whether two contacts contradict the reactions, rather than not being told by them.
    pub fn contradicts(&self) -> bool {
        matches!(self.pairs.first(), Some(Pair { first: Err(Unresolved::Inconsistent), .. }))
    }

    fn nothing(&mut self, samples: usize, why: Unresolved) {
        self.pairs.extend((0..samples).map(|_| Pair::without(why)));
        self.unexplained += samples;
    }
}

/// Both contacts of each sample of a run of consecutive stretches, dimensionless. `displacements` are those of the samples by errors that
/// all of them share.
pub(crate) fn resolve<I: Inverse>(
    rod: &I,
    track: &Track,
    noise: &Noise,
    pieces: &[Piece],
    [before, after]: [Option<&Neighbour>; 2],
    limits: &Limits,
    displacements: &[Correction],
) -> Resolution {
    let mut resolution = Resolution::default();
    let inside = |range: &Range<usize>| {
        let margin = limits.margin.min(range.len() / 8);
        range.start + margin..range.end - margin
    };
    let fitted: Vec<Option<Series>> = (0..pieces.len())
        .map(|k| {
            let mut range = inside(&pieces[k].range);
            let ends = [k == 0 && before.is_none(), k + 1 == pieces.len() && after.is_none()];
            let [from, to] = ends.map(|open| if open && rod.has_joints() { range.len() / PASSES_JOINT } else { 0 });
            (range.start, range.end) = (range.start + from, range.end - to);
            if range.len() < FEWEST_SAMPLES { None } else { Series::through(track, range, noise) }
        })
        .collect();
    let mut k = 0;
    while k < pieces.len() {
        let end = (k..pieces.len()).find(|&j| fitted[j].is_none()).unwrap_or(pieces.len());
        if end == k {
            let error = Unresolved::TooShort { samples: inside(&pieces[k].range).len(), least: FEWEST_SAMPLES };
            resolution.nothing(pieces[k].range.len(), error);
            k += 1;
            continue;
        }
        let at_end = |neighbour: Option<&Neighbour>, side: usize, here: bool| {
            let neighbour = neighbour.filter(|_| here)?;
            let piece = &pieces[if side == 0 { k } else { end - 1 }];
            let own = inside(&piece.range);
            let edge = track.tau[if side == 0 { own.start } else { own.end - 1 }];
            Single::beside(track, noise, &inside(&neighbour.range), side, own.len(), edge)
        };
        let singles = [at_end(before, 0, k == 0), at_end(after, 1, end == pieces.len())];
        let ends = singles.each_ref().map(|single| single.as_ref()?.contact(rod));
        let stretches = (k..end).filter_map(|j| Some((fitted[j].clone()?, pieces[j].label.tip()))).collect::<Vec<_>>();
        match solve(rod, stretches, ends, noise.is_clean()) {
            Ok(found) => {
                let spread = displaced(rod, &found, &singles, displacements);
                for ((part, piece), spread) in found.parts.iter().zip(&pieces[k..end]).zip(&spread) {
                    answer(rod, &found, part, &track.tau[piece.range.clone()], limits, spread, &mut resolution.pairs);
                }
                resolution.cost += found.solution.cost;
            }
            Err(error) => resolution.nothing(pieces[end - 1].range.end - pieces[k].range.start, error),
        }
        k = end;
    }
    resolution
}
