//! Which trail the first contact takes in each stretch of a run, and which contact goes on at its ends.

use super::trail::Trail;
use nalgebra::Vector2;

/// What is assumed at an end of a run. `bend` is the curvature of the contour along the neighbour's contact, 1/L.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum End {
    /// No contact goes on.
    Open,
    /// The second contact goes on as the neighbour's single contact: a point of the contour, its normal and its standard
    /// deviation across the contour; the path length of the clamp to there.
    Last { place: Vector2<f64>, normal: Vector2<f64>, sigma: f64, way: f64, bend: f64 },
    /// The first contact goes on as the neighbour's single contact, at this arc length with its standard deviation; the path length of
    /// the clamp to there.
    First { s: f64, sigma: f64, way: f64, bend: f64 },
}

/// A neighbour's single contact next to the run.
#[derive(Clone, Copy, Debug)]
pub(super) struct Beside {
    /// The end, if the second contact goes on.
    pub last: End,
    /// Arc length of the contact and its standard deviation.
    pub s: f64,
    pub sigma_s: f64,
    /// Path length of the clamp between the neighbour's samples and those of the run.
    pub way: f64,
    /// Curvature of the contour along the neighbour's contact, 1/L: at most this, given the noise.
    pub bend: f64,
}

impl Beside {
    /// The end, if the first contact goes on.
    pub fn first(&self) -> End {
        End::First { s: self.s, sigma: self.sigma_s, way: self.way, bend: self.bend }
    }
}

/// Most choices of trails along a run that are kept, best first. Each costs a rough solution.
const MOST_CHOICES: usize = 6;
/// Largest distance (rod lengths) between the ends of the trails of neighbouring stretches: trails are straight, and the first
/// contact is not.
const FARTHEST_JOINT: f64 = 0.1;
/// The neighbour's contact may be the first one within this many standard deviations more.
const NEAR: f64 = 2.0;
/// The neighbour's contact may be the second one where it is farther from the trail than this share of the distance.
const ANOTHER: f64 = 0.3;

/// A trail for each stretch, and an assumption for each end of the run.
#[derive(Clone)]
pub(super) struct Choice {
    pub trails: Vec<Trail>,
    pub ends: [End; 2],
    /// How badly trails fit the roots and each other: the smaller the likelier.
    off: f64,
}

/// The likeliest ways to choose a trail for each stretch and an assumption for each end.
pub(super) fn choices(found: &[Vec<Trail>], beside: [Option<Beside>; 2]) -> Vec<Choice> {
    let mut open = vec![Choice { trails: Vec::new(), ends: [End::Open; 2], off: 0.0 }];
    for trails in found {
        let longer = |choice: &Choice| {
            let end = choice.trails.last().map(|t| t.ends[1]);
            let off = choice.off;
            let mut all = Vec::new();
            for trail in trails {
                let gap = end.map_or(0.0, |e| (e - trail.ends[0]).abs());
                if gap < FARTHEST_JOINT {
                    let mut choice = choice.clone();
                    choice.trails.push(*trail);
                    choice.off = off + trail.off + gap / FARTHEST_JOINT;
                    all.push(choice);
                }
            }
            all
        };
        open = open.iter().flat_map(longer).collect();
        open.sort_by(|a, b| a.off.total_cmp(&b.off));
        open.truncate(MOST_CHOICES);
    }
    for (side, beside) in beside.into_iter().enumerate() {
        let Some(beside) = beside else { continue };
        let ended = |choice: &Choice| {
            let trail = if side == 0 { choice.trails.first() } else { choice.trails.last() };
            let off = trail.map_or(f64::INFINITY, |t| (t.ends[side] - beside.s).abs());
            let near = FARTHEST_JOINT + NEAR * beside.sigma_s;
            let mut all = Vec::new();
            for (end, possible) in [(beside.first(), off < near), (beside.last, off > ANOTHER * FARTHEST_JOINT)] {
                if possible {
                    let mut choice = choice.clone();
                    choice.ends[side] = end;
                    all.push(choice);
                }
            }
            all
        };
        open = open.iter().flat_map(ended).collect();
    }
    open.truncate(2 * MOST_CHOICES);
    open
}
