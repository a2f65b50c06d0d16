//! What several scans know of one contour, fused.
//!
//! Scan by scan: points of a new scan beside a stretch that is touched already improve the points of that stretch, by means weighted with the inverse
//! variances; its other points become chains of their own.

use crate::joined::joined;
use rod_reconstruct::{FittedObject, Knowledge};

/// Distance (rod lengths) within which the contours of two scans are the same stretch, if they run in the same direction.
const SAME: f64 = 0.03;
/// Smallest cosine between their directions.
const PARALLEL: f64 = 0.7;
/// Scans agree at a place within so many standard deviations of their distance; otherwise the more certain one is taken.
const AGREE: f64 = 5.0;
/// Distance beyond the end of a stretch, as a share of the way between its points, up to which a point is beside it.
const BEYOND: f64 = 0.4;

/// Distance of the ends of two chains, rod lengths, that are neighbours: that of the points of a fit.
const NEXT: f64 = 0.06;

/// A place of a contour.
#[derive(Clone, Copy, Debug)]
struct Place {
    at: [f64; 2],
    /// m
    sigma: f64,
}

/// The contours of some scans as one set of chains; `length` is that of the rod, m.
pub(super) fn fused(scans: &[Vec<FittedObject>], length: f64) -> Vec<FittedObject> {
    let chains = scans.iter().fold(Vec::new(), |known, scan| with_scan(&known, scan, length));
    joined(&chains, NEXT, length).into_iter().map(|joined| joined.contour).collect()
}

fn with_scan(known: &[FittedObject], scan: &[FittedObject], length: f64) -> Vec<FittedObject> {
    let reach = SAME * length;
    let mut chains = Vec::new();
    for object in known {
        // what is touched now is no longer only bounded
        add_kept(object, &mut chains, |k| match object.known[k] {
            Knowledge::Touched { sigma } => {
                let own = Place { at: object.points[k], sigma };
                let mean = nearest(scan, own.at, direction(object, k), reach).map_or(own, |other| own.mean(other));
                Some((mean.at, Knowledge::Touched { sigma: mean.sigma }))
            }
            Knowledge::Bounded { room } => kept_bound(scan, object, k, reach.max(room)),
            Knowledge::Unknown => None,
        });
    }
    for object in scan {
        add_kept(object, &mut chains, |k| match object.known[k] {
            Knowledge::Touched { .. } => {
                let is_new = nearest(known, object.points[k], direction(object, k), reach).is_none();
                is_new.then_some((object.points[k], object.known[k]))
            }
            Knowledge::Bounded { room } => kept_bound(known, object, k, reach.max(room)),
            Knowledge::Unknown => None,
        });
    }
    chains
}

/// A bounded point, unless a rod touched near to it.
fn kept_bound(others: &[FittedObject], object: &FittedObject, k: usize, reach: f64) -> Option<([f64; 2], Knowledge)> {
    let is_near = nearest(others, object.points[k], direction(object, k), reach).is_some();
    (!is_near).then_some((object.points[k], object.known[k]))
}

/// Adds the points of an object that are kept as chains, which end where one is not.
fn add_kept(
    object: &FittedObject,
    chains: &mut Vec<FittedObject>,
    kept: impl Fn(usize) -> Option<([f64; 2], Knowledge)>,
) {
    let mut chain: Option<FittedObject> = None;
    for k in 0..object.points.len() {
        match kept(k) {
            Some((point, known)) => {
                let none = || FittedObject { points: Vec::new(), vertices: Vec::new(), known: Vec::new() };
                let chain = chain.get_or_insert_with(none);
                if object.vertices.contains(&k) && !chain.points.is_empty() {
                    chain.vertices.push(chain.points.len());
                }
                chain.points.push(point);
                chain.known.push(known);
            }
            None => chains.extend(chain.take().and_then(ended)),
        }
    }
    chains.extend(chain.and_then(ended));
}

/// A chain that is ended, if any of it is touched.
fn ended(mut chain: FittedObject) -> Option<FittedObject> {
    let last = chain.points.len() - 1;
    chain.vertices.retain(|vertex| *vertex < last);
    chain.known.iter().any(|known| known.sigma().is_some()).then_some(chain)
}

impl Place {
    /// The mean with the same place of another scan; the more certain one where they disagree.
    fn mean(self, other: Self) -> Self {
        let apart = (self.at[0] - other.at[0]).hypot(self.at[1] - other.at[1]);
        if apart > AGREE * self.sigma.hypot(other.sigma) {
            return if other.sigma < self.sigma { other } else { self };
        }
        let [own, its] = [self, other].map(|place| place.sigma.max(f64::MIN_POSITIVE).powi(-2));
        let at = [0, 1].map(|k| (own * self.at[k] + its * other.at[k]) / (own + its));
        Self { at, sigma: (own + its).sqrt().recip() }
    }
}

/// The unit vector along a contour at a point.
fn direction(object: &FittedObject, k: usize) -> [f64; 2] {
    let (before, after) = (object.points[k.saturating_sub(1)], object.points[(k + 1).min(object.points.len() - 1)]);
    let (x, y) = (after[0] - before[0], after[1] - before[1]);
    let way = x.hypot(y).max(f64::MIN_POSITIVE);
    [x / way, y / way]
}

/// The place of a touched stretch nearest to a point; none where there is none within `reach` beside the point that runs in its direction.
fn nearest(objects: &[FittedObject], at: [f64; 2], direction: [f64; 2], reach: f64) -> Option<Place> {
    let mut best: Option<(Place, f64)> = None;
    for object in objects {
        let is_touched = |k: usize| object.known.get(k).is_some_and(|known| known.sigma().is_some());
        // the nearest place of the stretch so far, and whether the point is beyond an end of the stretch there: that is not beside it
        let mut nearest: Option<(Place, f64, bool)> = None;
        for k in 1..object.points.len() {
            let (Knowledge::Touched { sigma: before }, Knowledge::Touched { sigma: after }) =
                (object.known[k - 1], object.known[k])
            else {
                continue;
            };
            let (from, to) = (object.points[k - 1], object.points[k]);
            let way = [to[0] - from[0], to[1] - from[1]];
            let square = way[0] * way[0] + way[1] * way[1];
            let along = way[0] * direction[0] + way[1] * direction[1];
            let free = ((at[0] - from[0]) * way[0] + (at[1] - from[1]) * way[1]) / square;
            let starts = k.checked_sub(2).is_none_or(|k| !is_touched(k));
            let ends = !is_touched(k + 1);
            let share = free.clamp(0.0, 1.0);
            let place = [from[0] + share * way[0], from[1] + share * way[1]];
            let distance = (place[0] - at[0]).hypot(place[1] - at[1]);
            if along > PARALLEL * square.sqrt()
                && distance <= reach
                && nearest.is_none_or(|nearest| distance < nearest.1)
            {
                let is_beyond = (starts && free < -BEYOND) || (ends && free > 1.0 + BEYOND);
                nearest = Some((Place { at: place, sigma: before + share * (after - before) }, distance, is_beyond));
            }
            if ends
                && let Some((place, distance, false)) = nearest.take()
                && best.is_none_or(|best| distance < best.1)
            {
                best = Some((place, distance));
            }
        }
    }
    best.map(|best| best.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(from: i32, to: i32, y: f64, sigma: impl Fn(i32) -> f64) -> FittedObject {
        FittedObject {
            points: (from..=to).map(|k| [0.02 * f64::from(k), y]).collect(),
            vertices: Vec::new(),
            known: (from..=to).map(|k| Knowledge::Touched { sigma: sigma(k) }).collect(),
        }
    }

    #[test]
    fn two_scans_of_one_line_are_one_line_and_what_only_the_second_touched() {
        let left = line(0, 20, 0.0, |_| 1e-3);
        let right = line(10, 30, 1e-3, |_| 1e-3);
        let chains = fused(&[vec![left], vec![right]], 1.0);
        assert_eq!(chains.iter().map(|chain| chain.points.len()).collect::<Vec<_>>(), [31]);
        let (points, known) = (&chains[0].points, &chains[0].known);
        assert!(points[5][1] == 0.0 && (points[15][1] - 5e-4).abs() < 1e-15 && points[21][1] == 1e-3);
        assert!((known[15].sigma().unwrap() - 1e-3 / 2.0_f64.sqrt()).abs() < 1e-15);
    }

    /// Beside neither the last touched step of the other scan, which is short, nor the one before it.
    #[test]
    fn a_point_beyond_the_end_of_another_scan_stays_where_it_is() {
        let first = line(0, 20, 0.0, |_| 1e-3);
        let mut second = line(8, 12, 0.0, |_| 1e-3);
        second.points = vec![[0.16, 0.0], [0.18, 0.0], [0.185, 0.0], [0.19, 0.0], [0.21, 0.0]];
        second.known[4] = Knowledge::Bounded { room: 0.05 };
        let chains = fused(&[vec![first], vec![second]], 1.0);
        assert_eq!(chains.len(), 1);
        let places: Vec<f64> = chains[0].points.iter().map(|point| point[0]).collect();
        assert!(places.is_sorted() && (places[10] - 0.2).abs() < 1e-15, "{places:?}");
    }

    #[test]
    fn a_bound_ends_where_another_scan_touched() {
        let mut first = line(0, 20, 0.0, |_| 1e-3);
        first.known[8..13].fill(Knowledge::Bounded { room: 0.05 });
        let second = line(8, 12, 0.02, |_| 1e-3);
        let chains = fused(&[vec![first], vec![second]], 1.0);
        assert_eq!(chains.iter().map(|chain| chain.points.len()).collect::<Vec<_>>(), [21]);
        assert!(chains[0].known.iter().all(|known| known.sigma().is_some()));
    }
}
