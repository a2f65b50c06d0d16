//! Samples of a clamp that stands still.

use super::quantum::usual;
use crate::point::Clamp;
use nalgebra::Vector3;

/// Poses within this distance (rod lengths) are the same but for rounding.
const SAME: f64 = 1e-12;
/// Samples of a clamp that trembles within this many standard deviations belong to one stop ...
const SIGMAS: f64 = 4.0;
/// ... if there are at least as many. Fewer: a clamp that moves slowly is taken for one that stops.
const LONG: usize = 32;
/// Where the reactions change during a stop by more than this share of what they change from stop to stop, the clamp moved on, and
/// the encoder that told its pose is coarse. Noise alone gives 0.
const MOVED: f64 = 0.5;
/// Share of the samples that must be in stops for the clamp to go from stop to stop. Less: single repeated poses are left to the smoothing of the path.
const SHARE: f64 = 0.5;
/// A clamp that moves on stands still where it stays in one place for so many times as many samples as it usually does. Smaller: where it slows down, what a coarse
/// encoder shows is a stop; larger: short stops are left to the smoothing of the path, which moves the poses beside them.
const LONGER: usize = 4;

/// Consecutive samples in one place, averaged.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stop {
    pub clamp: Clamp,
    /// Number of samples.
    pub count: usize,
}

/// Joins the samples of stops to their means; a sample on the way is a stop of its own. `trembling` is the standard deviation of a
/// pose, rod lengths.
pub(super) fn stops(clamps: &[Clamp], trembling: f64) -> Vec<Stop> {
    let resting: Vec<usize> = groups(clamps, SAME);
    let standing =
        |groups: &[usize], least: usize| groups.iter().filter(|count| **count >= least).sum::<usize>() as f64;
    let enough = SHARE * clamps.len() as f64;
    let goes = standing(&resting, 2) > enough;
    if goes && !moves(clamps, &resting) {
        return average_groups(clamps, &resting, 2);
    }
    let resting = if goes { resting } else { groups(clamps, (SIGMAS * trembling).max(SAME)) };
    let steps = !goes && standing(&resting, LONG) > enough;
    let least = if steps { LONG } else { (LONGER * usual(resting.iter().copied())).max(2) };
    average_groups(clamps, &resting, least)
}

/// Lengths of the groups of consecutive poses within `distance` of their first ones' mean.
fn groups(clamps: &[Clamp], distance: f64) -> Vec<usize> {
    let mut groups: Vec<usize> = Vec::new();
    let mut sum = Vector3::zeros();
    for clamp in clamps {
        match groups.last_mut() {
            Some(count) if (clamp.pose - sum / *count as f64).norm() <= distance => {
                *count += 1;
                sum += clamp.pose;
            }
            _ => {
                groups.push(1);
                sum = clamp.pose;
            }
        }
    }
    groups
}

fn average_groups(clamps: &[Clamp], groups: &[usize], least: usize) -> Vec<Stop> {
    let mut rest = clamps;
    let mut stops = Vec::with_capacity(groups.len());
    for &count in groups {
        let (here, after) = rest.split_at(count.min(rest.len()));
        if count >= least {
            stops.push(Stop { clamp: mean(here), count });
        } else {
            stops.extend(here.iter().map(|clamp| Stop { clamp: *clamp, count: 1 }));
        }
        rest = after;
    }
    stops
}

fn mean(clamps: &[Clamp]) -> Clamp {
    let share = 1.0 / clamps.len().max(1) as f64;
    // relative to the first, so that equal poses stay as they are
    let first = clamps
        .first()
        .map_or(Clamp { pose: Vector3::zeros(), reactions: Vector3::zeros(), natural: 0.0, friction: 0.0 }, |clamp| {
            *clamp
        });
    let sum = |of: fn(&Clamp) -> Vector3<f64>| {
        clamps.iter().map(|clamp| of(clamp) - of(&first)).sum::<Vector3<f64>>() * share
    };
    Clamp {
        pose: first.pose + sum(|clamp| clamp.pose),
        reactions: first.reactions + sum(|clamp| clamp.reactions),
        ..first
    }
}

/// Whether the reactions go on during the stops as they do from one to the next.
fn moves(clamps: &[Clamp], groups: &[usize]) -> bool {
    let mut rest = clamps;
    let mut before: Option<Vector3<f64>> = None;
    let (mut product, mut square) = (Vector3::zeros(), Vector3::zeros());
    for &count in groups {
        let (here, after) = rest.split_at(count.min(rest.len()));
        rest = after;
        let whole = mean(here).reactions;
        if let Some(before) = before.filter(|_| count >= 2) {
            // the rise from the first half to the second is half of that over the whole stop
            let half = count / 2;
            let rise = 2.0 * (mean(&here[count - half..]).reactions - mean(&here[..half]).reactions) * half as f64
                / (count - half) as f64;
            let change: Vector3<f64> = whole - before;
            product += rise.component_mul(&change);
            square += change.component_mul(&change);
        }
        before = Some(whole);
    }
    let share = |c: usize| if square[c] > 0.0 { product[c] / square[c] } else { 0.0 };
    (0..3).any(|c| share(c) > MOVED)
}
