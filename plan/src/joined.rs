//! Contours of one object, joined.

use rod_reconstruct::{FittedObject, Knowledge};
use std::ops::Range;

/// A contour that is made of several.
#[derive(Clone, Debug)]
pub(crate) struct Joined {
    pub contour: FittedObject,
    /// The points with which its parts begin, but for the first: between each and the point before it nothing was measured.
    pub starts: Vec<usize>,
}

/// Distance of places that were touched, rod lengths, between which the border goes on: that of neighbouring points of a fit.
const NEXT: f64 = 0.06;

/// Distance of consecutive points below which they have no direction, rod lengths: a seventh of that of the points of a fit.
const DISTINCT: f64 = 0.003;

/// Contours joined where the end of one and the start of another are nearer than `most`: between two places that were touched the border of
/// one object is taken to go on. The nearest are joined first. `length` is that of the rod, m; `most` is in rod lengths.
pub(crate) fn joined(contours: &[FittedObject], most: f64, length: f64) -> Vec<Joined> {
    let mut contours = joined_ends(&without_bounded_ends(contours, NEXT * length), most * length);
    contours.iter_mut().for_each(|one| one.thin_out(DISTINCT * length));
    contours.retain(|one| one.contour.points.len() > 1);
    contours
}

/// Without the bounded points beyond the touched end of a contour, where the touched start of another one is nearer than `near` (m) to that end: there the border is known to go
/// on elsewhere, as at a corner.
fn without_bounded_ends(contours: &[FittedObject], near: f64) -> Vec<FittedObject> {
    let is_touched = |known: &Knowledge| known.sigma().is_some();
    let ends: Vec<Option<[usize; 2]>> = contours
        .iter()
        .map(|one| Some([one.known.iter().position(is_touched)?, one.known.iter().rposition(is_touched)?]))
        .collect();
    let all = contours.iter().zip(&ends).enumerate().map(|(number, (contour, own))| {
        let Some([first, last]) = *own else { return contour.clone() };
        // one of them is the end of the one, and 0 the start of the other
        let goes_on = |at: usize, other_end: usize| {
            let others = contours.iter().zip(&ends).enumerate().filter(|(other, _)| *other != number);
            let mut places = others.filter_map(|(_, (other, ends))| Some(other.points[ends.as_ref()?[other_end]]));
            let [x, y] = contour.points[at];
            places.any(|place| (place[0] - x).hypot(place[1] - y) < near)
        };
        let from = if goes_on(first, 1) { first } else { 0 };
        let to = if goes_on(last, 0) { last } else { contour.points.len() - 1 };
        part(contour, from, to)
    });
    all.collect()
}

impl Joined {
    /// Leaves out the less certain of two consecutive points that are nearer than `least` (m). A vertex stays one.
    fn thin_out(&mut self, least: f64) {
        let sigma = |known: &Knowledge| known.sigma().unwrap_or(f64::INFINITY);
        let mut k = 1;
        while k < self.contour.points.len() && self.contour.points.len() > 2 {
            let contour = &self.contour;
            let (before, after) = (contour.points[k - 1], contour.points[k]);
            if (after[0] - before[0]).hypot(after[1] - before[1]) >= least {
                k += 1;
                continue;
            }
            let left = if sigma(&contour.known[k - 1]) > sigma(&contour.known[k]) { k - 1 } else { k };
            self.leave_out(left, k);
        }
    }

    /// Without the points that make it cross itself; `crossing` gives the place (m) where a contour does. At each crossing a loop or an end is left out, the part with the fewest
    /// points. None where that would be more than half of all points, or where no contour passes through them.
    pub fn untangled(mut self, crossing: impl Fn(&FittedObject) -> Result<Option<[f64; 2]>, ()>) -> Option<Self> {
        let least = self.contour.points.len() / 2;
        while let Some(place) = crossing(&self.contour).ok()? {
            let points = &self.contour.points;
            let distance = |k: &usize| distance_to_step([points[*k], points[k + 1]], place);
            let mut steps: Vec<usize> = (0..points.len() - 1).collect();
            steps.sort_by(|one, other| distance(one).total_cmp(&distance(other)));
            let [one, other] = *steps.first_chunk::<2>()?;
            let (one, other) = (one.min(other) + 1, one.max(other) + 1);
            let parts = [0..one, one..other, other..points.len()];
            self.leave_out_part(parts.into_iter().min_by_key(ExactSizeIterator::len)?);
            if self.contour.points.len() < least.max(2) {
                return None;
            }
        }
        Some(self)
    }

    /// Leaves out some points in a row; nothing is measured between those before and after them.
    fn leave_out_part(&mut self, part: Range<usize>) {
        let Self { contour, starts } = self;
        let (first, count) = (part.start, part.len());
        let moved = |k: usize| if k < part.end { k.min(first) } else { k - count };
        contour.vertices.retain(|vertex| !part.contains(vertex));
        contour.vertices.iter_mut().for_each(|vertex| *vertex = moved(*vertex));
        starts.push(first);
        starts.iter_mut().for_each(|start| *start = moved(*start));
        contour.points.drain(part.clone());
        contour.known.drain(part);
        let last = contour.points.len().saturating_sub(1);
        contour.vertices.retain(|vertex| (1..last).contains(vertex));
        starts.retain(|start| (1..=last).contains(start));
        starts.sort_unstable();
        starts.dedup();
    }

    /// Leaves one point of a pair out, whose second one is `k`; nothing is left between the two that is not measured.
    fn leave_out(&mut self, left: usize, k: usize) {
        let Self { contour, starts } = self;
        contour.points.remove(left);
        contour.known.remove(left);
        let last = contour.points.len() - 1;
        contour.vertices.iter_mut().for_each(|vertex| *vertex -= usize::from(*vertex >= k));
        contour.vertices.dedup();
        contour.vertices.retain(|vertex| (1..last).contains(vertex));
        starts.retain(|start| *start != k);
        starts.iter_mut().for_each(|start| *start -= usize::from(*start > k));
    }
}

/// Distance (m) of a place from the way from one point to another.
fn distance_to_step([from, to]: [[f64; 2]; 2], place: [f64; 2]) -> f64 {
    let (way, own) = ([to[0] - from[0], to[1] - from[1]], [place[0] - from[0], place[1] - from[1]]);
    let share = ((own[0] * way[0] + own[1] * way[1]) / (way[0] * way[0] + way[1] * way[1])).clamp(0.0, 1.0);
    (own[0] - share * way[0]).hypot(own[1] - share * way[1])
}

fn joined_ends(contours: &[FittedObject], most: f64) -> Vec<Joined> {
    let known = contours.iter().map(without_unknown_ends).filter(|one| !one.points.is_empty());
    let mut contours: Vec<Joined> = known.map(|contour| Joined { contour, starts: Vec::new() }).collect();
    loop {
        let mut best: Option<(f64, usize, usize)> = None;
        for (one, before) in contours.iter().enumerate() {
            for (other, after) in contours.iter().enumerate().filter(|(other, _)| *other != one) {
                let (Some(end), Some(start)) = (before.contour.points.last(), after.contour.points.first()) else {
                    continue;
                };
                let apart = (start[0] - end[0]).hypot(start[1] - end[1]);
                if apart < best.map_or(most, |best| best.0) {
                    best = Some((apart, one, other));
                }
            }
        }
        let Some((_, one, other)) = best else { return contours };
        let after = contours[other].clone();
        append(&mut contours[one], after);
        contours.remove(other);
    }
}

/// Largest turn (rad) between the end of a contour and the way from there to the next one that a spline bridges.
const SHARP: f64 = 0.5;

/// Whether the way from the end of a contour to the start of the next turns sharply.
fn is_sharp(before: &FittedObject, after: &FittedObject) -> bool {
    let chord = |from: [f64; 2], to: [f64; 2]| (to[1] - from[1]).atan2(to[0] - from[0]);
    let (Some(end), Some(start)) = (before.points.last(), after.points.first()) else { return false };
    let bridge = chord(*end, *start);
    let turns = |angle: f64| (angle - bridge).cos() < SHARP.cos();
    let is_turned_before = before.points.last_chunk::<2>().is_some_and(|[from, to]| turns(chord(*from, *to)));
    is_turned_before || after.points.first_chunk::<2>().is_some_and(|[from, to]| turns(chord(*from, *to)))
}

/// Largest cosine between a contour and the way from its end to the next one if the two overlap: at a corner, however sharp, that way does not lead back along both.
const BACK: f64 = -0.5;

/// How many points at the end of a contour, and at the start of the next one, overlap: between the rest of both the way does not lead back. Of two ends the less certain one is
/// left out; one of the contours may be left out as a whole.
fn overlap(before: &FittedObject, after: &FittedObject) -> (usize, usize) {
    let (mut end, mut start) = (before.points.len(), 0);
    let cosine = |[a, b]: [[f64; 2]; 2], [c, d]: [[f64; 2]; 2]| {
        let (one, other) = ([b[0] - a[0], b[1] - a[1]], [d[0] - c[0], d[1] - c[1]]);
        (one[0] * other[0] + one[1] * other[1]) / (one[0].hypot(one[1]) * other[0].hypot(other[1]))
    };
    while end > 0 && start < after.points.len() {
        let bridge = [before.points[end - 1], after.points[start]];
        let ways = [before.points[..end].last_chunk::<2>(), after.points[start..].first_chunk::<2>()];
        let mut ways = ways.into_iter().flatten().peekable();
        if ways.peek().is_none() || ways.any(|way| cosine(*way, bridge) > BACK) {
            break;
        }
        let sigma = |known: &Knowledge| known.sigma().unwrap_or(f64::INFINITY);
        if sigma(&before.known[end - 1]) > sigma(&after.known[start]) { end -= 1 } else { start += 1 }
    }
    (before.points.len() - end, start)
}

fn append(before: &mut Joined, mut after: Joined) {
    let (ends, starts) = overlap(&before.contour, &after.contour);
    if starts == after.contour.points.len() {
        return;
    }
    if ends == before.contour.points.len() {
        *before = after;
        return;
    }
    before.contour = part(&before.contour, 0, before.contour.points.len() - 1 - ends);
    before.starts.retain(|start| *start < before.contour.points.len());
    after.contour = part(&after.contour, starts, after.contour.points.len() - 1);
    let kept = after.starts.iter().filter(|start| **start > starts).map(|start| start - starts);
    after.starts = kept.collect();
    let (Joined { contour, starts }, Joined { contour: after, starts: its_starts }) = (before, after);
    let first = contour.points.len();
    starts.push(first);
    starts.extend(its_starts.iter().map(|start| start + first));
    if is_sharp(contour, &after) {
        // a spline would overshoot
        contour.vertices.extend([first - 1].iter().filter(|vertex| **vertex > 0));
        contour.vertices.extend([first].iter().filter(|_| after.points.len() > 1));
    }
    contour.vertices.extend(after.vertices.iter().map(|vertex| vertex + first));
    contour.points.extend(after.points);
    contour.known.extend(after.known);
}

/// From the first to the last point of which anything is known.
fn without_unknown_ends(contour: &FittedObject) -> FittedObject {
    let is_known = |known: &Knowledge| *known != Knowledge::Unknown;
    match (contour.known.iter().position(is_known), contour.known.iter().rposition(is_known)) {
        (Some(first), Some(last)) => part(contour, first, last),
        _ => FittedObject { points: Vec::new(), vertices: Vec::new(), known: Vec::new() },
    }
}

/// The runs of its points that were touched.
pub(crate) fn touched_runs(contour: &FittedObject) -> Vec<FittedObject> {
    let is_touched = |k: &usize| contour.known[*k].sigma().is_some();
    let touched: Vec<usize> = (0..contour.points.len()).filter(is_touched).collect();
    touched.chunk_by(|one, next| one + 1 == *next).map(|run| part(contour, run[0], run[run.len() - 1])).collect()
}

/// From one of its points to another.
fn part(contour: &FittedObject, first: usize, last: usize) -> FittedObject {
    let vertices =
        contour.vertices.iter().filter(|vertex| (first + 1..last).contains(vertex)).map(|vertex| vertex - first);
    FittedObject {
        points: contour.points[first..=last].to_vec(),
        vertices: vertices.collect(),
        known: contour.known[first..=last].to_vec(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contours_are_joined_end_to_start_without_what_is_not_known() {
        let line = |from: f64, known: Knowledge| FittedObject {
            points: vec![[from, 0.0], [from + 1.0, 0.0], [from + 2.0, 0.0]],
            vertices: vec![1],
            known: vec![known, Knowledge::Touched { sigma: 0.1 }, Knowledge::Touched { sigma: 0.1 }],
        };
        let [left, right] = [line(0.0, Knowledge::Unknown), line(2.5, Knowledge::Bounded { room: 0.2 })];
        let one = joined(&[right.clone(), left.clone()], 1.0, 1.0);
        assert_eq!(one.len(), 1);
        let Joined { contour, starts } = &one[0];
        assert_eq!((contour.points.len(), starts.as_slice()), (5, [2].as_slice()));
        assert_eq!((contour.points[0], contour.points[2]), ([1.0, 0.0], [2.5, 0.0]));
        assert_eq!(contour.vertices, [3]);
        assert_eq!(joined(&[left, right], 0.4, 1.0).len(), 2);
    }

    /// Of two fits of one contour the ends may lie beside each other, one of them alone.
    #[test]
    fn contours_whose_ends_overlap_do_not_run_back() {
        let line = |places: &[f64], sigma: f64| FittedObject {
            points: places.iter().map(|x| [*x, 0.0]).collect(),
            vertices: Vec::new(),
            known: vec![Knowledge::Touched { sigma }; places.len()],
        };
        let ways =
            [line(&[0.0, 1.0, 2.0], 0.1), line(&[1.6], 0.2), line(&[3.0, 4.0], 0.1), line(&[3.8, 5.0, 6.0], 0.05)];
        let all = joined(&ways, 1.5, 1.0);
        assert_eq!(all.len(), 1);
        let places: Vec<f64> = all[0].contour.points.iter().map(|point| point[0]).collect();
        assert_eq!(places, [0.0, 1.0, 2.0, 3.0, 3.8, 5.0, 6.0]);
        assert_eq!((all[0].contour.known.len(), all[0].starts.as_slice()), (7, [3, 4].as_slice()));
    }

    /// A rod that lies on a corner bounds the object beyond it, along the side that it comes from; another scan touched the other side.
    #[test]
    fn a_bound_beyond_a_corner_gives_way_to_the_side_that_was_touched() {
        let touched = Knowledge::Touched { sigma: 1e-4 };
        let side = |points: &[[f64; 2]], known: &[Knowledge]| FittedObject {
            points: points.to_vec(),
            vertices: Vec::new(),
            known: known.to_vec(),
        };
        let bounded = Knowledge::Bounded { room: 0.01 };
        let one = side(
            &[[-0.04, 0.0], [-0.02, 0.0], [0.0, 0.0], [0.02, 0.0], [0.04, 0.0]],
            &[touched, touched, touched, bounded, bounded],
        );
        let other =
            side(&[[0.001, 0.001], [0.0, 0.02], [0.0, 0.04]], &[Knowledge::Touched { sigma: 1e-3 }, touched, touched]);
        let all = joined(&[one, other], 1.0, 1.0);
        assert_eq!(all.len(), 1);
        // the two points at the corner are one
        assert_eq!(all[0].contour.points, [[-0.04, 0.0], [-0.02, 0.0], [0.0, 0.0], [0.0, 0.02], [0.0, 0.04]]);
        assert_eq!((all[0].contour.vertices.as_slice(), all[0].starts.is_empty()), ([2].as_slice(), true));
    }

    /// The two sides of a sharp corner are not beside each other.
    #[test]
    fn both_sides_of_a_sharp_corner_stay() {
        let side = |points: [[f64; 2]; 2]| FittedObject {
            points: points.to_vec(),
            vertices: Vec::new(),
            known: vec![Knowledge::Touched { sigma: 0.1 }; 2],
        };
        let all = joined(&[side([[0.0, 0.0], [0.9, 0.0]]), side([[0.85, 0.06], [0.2, 0.46]])], 0.5, 1.0);
        assert_eq!((all.len(), all[0].contour.points.len()), (1, 4));
    }
}
