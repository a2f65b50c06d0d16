//! Contours of one object, joined.

use rod_reconstruct::{FittedObject, Knowledge};

/// A contour that is made of several.
#[derive(Clone, Debug)]
pub(crate) struct Joined {
    pub contour: FittedObject,
    /// The points with which its parts begin, but for the first: between each and the point before it nothing was measured.
    pub starts: Vec<usize>,
}

/// Contours joined where the end of one and the start of another are nearer than `most` (m): between two places that were touched the border of
/// one object is taken to go on. The nearest are joined first.
pub(crate) fn joined(contours: &[FittedObject], most: f64) -> Vec<Joined> {
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
        let Some((_, one, other)) = best else {
            contours.retain(|one| one.contour.points.len() > 1);
            return contours;
        };
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

fn append(Joined { contour, starts }: &mut Joined, Joined { contour: after, starts: its_starts }: Joined) {
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
        let one = joined(&[right.clone(), left.clone()], 1.0);
        assert_eq!(one.len(), 1);
        let Joined { contour, starts } = &one[0];
        assert_eq!((contour.points.len(), starts.as_slice()), (5, [2].as_slice()));
        assert_eq!((contour.points[0], contour.points[2]), ([1.0, 0.0], [2.5, 0.0]));
        assert_eq!(contour.vertices, [3]);
        assert_eq!(joined(&[left, right], 0.4).len(), 2);
    }
}
