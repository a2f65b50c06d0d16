//! Objects that agree with what is known: how the contour may go on where no rod was.
//!
//! The model: contours whose ends are nearer than a rod length belong to one object. Beyond its ends a contour goes on with a constant
//! curvature, one of those along it, each as likely, for a rod length at most. Ends that turn towards each other there meet, unless they are far apart. Between touched points the hollows that the rod bridged are deeper or
//! shallower by a share of the room of the points, the same all along, uniform from -1 to 1. The touched points stay where they are.

use crate::joined::{Joined, joined, touched_runs};
use crate::{IntervalSet, Outline, support};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rod_contours::{Composite, Contour, ContourError, Line, Range, Spline, SplineEnd};
use rod_reconstruct::{FittedObject, Knowledge};
use std::cell::LazyCell;
use std::f64::consts::PI;

/// How far a contour goes on beyond its ends, rod lengths: a scan reaches no farther. The later ones where ends as long cross the rest of the contour.
const ON: [f64; 3] = [1.0, 0.5, 0.0];

/// Distance of the points there, rod lengths.
const APART: f64 = 0.03;

/// Turn (rad) that is left between the ends at the back of an object, which the spline that closes it bridges. Smaller: its ends may cross.
const OPEN: f64 = 0.3;

/// Largest distance of ends that have turned towards each other, rod lengths, that are taken to meet: a rod bridges no wider gap between them.
const MEET: f64 = 0.5;

/// Directions that are tried, up to a right angle, where a contour cannot go straight on.
const TURNS: i32 = 6;

/// Largest distance (rod lengths) of the touched ends of contours between which they count as touched: that of neighbouring points of a fit.
const NEIGHBOURS: f64 = 0.06;

/// How often a hypothesis is drawn anew whose contour crosses itself. Then it is left out.
const DRAWS: usize = 20;

/// What of the contours objects are drawn through.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Drawn {
    Whole,
    Touched,
    /// What is touched, without points at which it crosses itself.
    Untangled,
}

/// An object that agrees with what is known.
#[derive(Clone, Debug)]
pub struct Hypothesis {
    /// Objects.
    pub objects: Vec<Composite>,
    /// Their outlines.
    pub outlines: Vec<Outline>,
    /// What of each outline is touched before.
    pub touched: Vec<IntervalSet>,
    /// Touched points (m) through which no object is drawn, because its contour would cross itself there.
    pub left_out: Vec<[f64; 2]>,
}

impl Hypothesis {
    /// The most plausible object, followed by `count` draws with a seed; fewer where what is known gives no contour. `length` is that of the rod, m;
    /// beyond its ends a contour stays where it `may_be`.
    pub(crate) fn all(
        contours: &[FittedObject],
        length: f64,
        (count, seed): (usize, u64),
        may_be: &dyn Fn([f64; 2]) -> bool,
    ) -> Vec<Self> {
        let whole = joined(contours, 1.0, length);
        // bounded stretches of two scans may overlap, so that the contour would cross itself
        let touched =
            LazyCell::new(|| joined(&contours.iter().flat_map(touched_runs).collect::<Vec<_>>(), 1.0, length));
        let untangled = LazyCell::new(|| touched.iter().filter_map(|one| one.clone().untangled(crossing)).collect());
        let attempts =
            ON.into_iter().flat_map(|on| [Drawn::Whole, Drawn::Touched, Drawn::Untangled].map(|of| (of, on)));
        let found = attempts.into_iter().find_map(|(drawn, on)| {
            let contours: &Vec<Joined> = match drawn {
                Drawn::Whole => &whole,
                Drawn::Touched => &touched,
                Drawn::Untangled => &untangled,
            };
            let mut straight = || 0.0;
            let middle = Self::of(contours, (length, on), &mut |curvatures| median(curvatures), &mut straight, may_be);
            Some((drawn, contours, on, middle?))
        });
        let Some((drawn, contours, on, middle)) = found else { return Vec::new() };
        let left_out: Vec<[f64; 2]> = if drawn == Drawn::Untangled {
            let is_drawn = |point: &[f64; 2]| contours.iter().any(|one| one.contour.points.contains(point));
            touched.iter().flat_map(|one| &one.contour.points).filter(|point| !is_drawn(point)).copied().collect()
        } else {
            Vec::new()
        };
        let mut all = vec![middle];
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        for _ in 0..count {
            for _ in 0..DRAWS {
                let mut depths: Vec<f64> = (0..256).map(|_| 2.0 * random.random::<f64>() - 1.0).collect();
                let mut curvature = |curvatures: &[f64]| match curvatures.len() {
                    0 => 0.0,
                    count => curvatures[((random.random::<f64>() * count as f64) as usize).min(count - 1)],
                };
                if let Some(drawn) =
                    Self::of(contours, (length, on), &mut curvature, &mut || depths.pop().unwrap_or(0.0), may_be)
                {
                    all.push(drawn);
                    break;
                }
            }
        }
        all.into_iter().map(|one| Self { left_out: left_out.clone(), ..one }).collect()
    }

    fn of(
        contours: &[Joined],
        (length, on): (f64, f64),
        curvature: &mut dyn FnMut(&[f64]) -> f64,
        depth: &mut dyn FnMut() -> f64,
        may_be: &dyn Fn([f64; 2]) -> bool,
    ) -> Option<Self> {
        let (mut objects, mut touched_points) = (Vec::new(), Vec::new());
        for Joined { contour, .. } in contours {
            let inner = deepened(contour, depth);
            let (object, points) = went_on(&inner, (length, on), curvature, may_be)?;
            objects.push(object);
            touched_points.push(points);
        }
        let outlines: Vec<Outline> =
            objects.iter().map(|object| support::outline(object, &[])).collect::<Option<_>>()?;
        let shapes = objects.iter().zip(&outlines).zip(&touched_points);
        let touched = shapes.zip(contours).map(|(((object, outline), points), Joined { starts, .. })| {
            let mut touched = IntervalSet::default();
            // the last pair closes the contour
            for before in 0..points.len() {
                let after = (before + 1) % points.len();
                let (Some(from), Some(to)) = (points[before], points[after]) else { continue };
                let is_near = (to[0] - from[0]).hypot(to[1] - from[1]) < NEIGHBOURS * length;
                let is_measured =
                    if after == 0 { is_near && outline.is_closed() } else { is_near || !starts.contains(&after) };
                let place = |[x, y]: [f64; 2]| outline.nearest(object, x, y);
                if let (true, Some(from), Some(to)) = (is_measured, place(from), place(to)) {
                    insert(&mut touched, outline, from, to);
                }
            }
            touched
        });
        let touched = touched.collect();
        (!objects.is_empty()).then_some(Self { objects, outlines, touched, left_out: Vec::new() })
    }
}

/// With each run of bounded points moved outward by a share of their room.
fn deepened(contour: &FittedObject, depth: &mut dyn FnMut() -> f64) -> FittedObject {
    let (mut moved, last) = (contour.clone(), contour.points.len() - 1);
    let mut share = None;
    for k in 0..contour.points.len() {
        let Knowledge::Bounded { room } = contour.known[k] else {
            share = None;
            continue;
        };
        let share = *share.get_or_insert_with(&mut *depth);
        let (before, after) = (contour.points[k.saturating_sub(1)], contour.points[(k + 1).min(last)]);
        let (dx, dy) = (after[0] - before[0], after[1] - before[1]);
        let chord = dx.hypot(dy);
        // the solid is on the left
        moved.points[k][0] += share * room * dy / chord;
        moved.points[k][1] -= share * room * dx / chord;
    }
    moved
}

/// Where the smooth pieces through the points of a contour cross, m; an error where they are none for another reason.
fn crossing(contour: &FittedObject) -> Result<Option<[f64; 2]>, ()> {
    match Composite::new(pieces(&contour.points, &contour.vertices).ok_or(())?) {
        Ok(_) => Ok(None),
        Err(ContourError::Crosses { x, y, .. }) => Ok(Some([x, y])),
        Err(_) => Err(()),
    }
}

/// The object with both ends gone on, by `on` rod lengths of `length` (m) at most, and its points, none for those that are not touched.
fn went_on(
    contour: &FittedObject,
    (length, on): (f64, f64),
    curvature: &mut dyn FnMut(&[f64]) -> f64,
    may_be: &dyn Fn([f64; 2]) -> bool,
) -> Option<(Composite, Vec<Option<[f64; 2]>>)> {
    let smooth = pieces(&contour.points, &contour.vertices)?;
    let (first, last) = (smooth.first()?, smooth.last()?);
    let (start, end) = (first.frame(first.range().from), last.frame(last.range().to));
    let mut curvatures = Vec::new();
    for piece in &smooth {
        let Range { from, to } = piece.range();
        // splines bend at their points; ends of natural ones are straight
        curvatures.extend((1..8).map(|k| piece.frame(from + (to - from) * f64::from(k) / 8.0).curvature()));
    }
    let turn = turn_of(&contour.points);
    let most = (0.5 * (2.0 * PI - OPEN - turn.abs())).max(0.0);
    let (step, farthest) = (APART * length, (on / APART) as usize);
    let mut beyond = |x: f64, y: f64, alpha: f64, forwards: bool| {
        let kappa = curvature(&curvatures);
        let sign = if forwards { 1.0 } else { -1.0 };
        let (mut at, mut angle, mut turned) = ([x, y], alpha, 0.0);
        let mut points = Vec::new();
        while points.len() < farthest && turned + kappa.abs() * step <= most {
            angle += sign * 0.5 * kappa * step;
            let ahead = |turn: f64| {
                let (sin, cos) = (angle + sign * turn).sin_cos();
                [1.0, 0.5].map(|share| [at[0] + sign * share * step * cos, at[1] + sign * share * step * sin])
            };
            // where it cannot be it turns towards the solid
            let turns = (0..=TURNS).map(|k| f64::from(k) * PI / f64::from(2 * TURNS));
            let Some(turn) = turns.into_iter().find(|turn| ahead(*turn).into_iter().all(may_be)) else { break };
            at = ahead(turn)[0];
            angle += sign * (turn + 0.5 * kappa * step);
            turned += turn + kappa.abs() * step;
            points.push(at);
        }
        points
    };
    let mut before = beyond(start.x, start.y, start.alpha, false);
    before.reverse();
    let after = beyond(end.x, end.y, end.alpha, true);
    let vertices: Vec<usize> = contour.vertices.iter().map(|vertex| vertex + before.len()).collect();
    let points: Vec<[f64; 2]> = before.iter().chain(&contour.points).chain(&after).copied().collect();
    let (first, last) = (points.first()?, points.last()?);
    // ends that went on as far as they may have turned towards each other
    let meets = before.len().max(after.len()) < farthest
        && (first[0] - last[0]).hypot(first[1] - last[1]) < MEET * length
        && points.len() > 3;
    let pieces = if meets { closed_pieces(points, &vertices)? } else { pieces(&points, &vertices)? };
    let object = Composite::new(pieces).ok()?;
    let is_touched =
        |(point, known): (&[f64; 2], &Knowledge)| matches!(known, Knowledge::Touched { .. }).then_some(*point);
    Some((object, contour.points.iter().zip(&contour.known).map(is_touched).collect()))
}

/// By how much (rad) a line through points turns to the left, from its first chord to its last.
fn turn_of(points: &[[f64; 2]]) -> f64 {
    let chords: Vec<[f64; 2]> =
        points.windows(2).map(|pair| [pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]]).collect();
    let turn = |pair: &[[f64; 2]]| {
        let [a, b] = [pair[0], pair[1]];
        (a[0] * b[1] - a[1] * b[0]).atan2(a[0] * b[0] + a[1] * b[1])
    };
    chords.windows(2).map(turn).sum()
}

/// Adds the part of an outline from one place to another, which may pass the start of a closed one.
fn insert(touched: &mut IntervalSet, outline: &Outline, from: f64, to: f64) {
    if from > to && outline.is_closed() && from - to > 0.5 * outline.length() {
        touched.insert(from, outline.length());
        touched.insert(0.0, to);
    } else {
        touched.insert(from, to);
    }
}

/// Smooth pieces between vertices.
fn pieces(points: &[[f64; 2]], vertices: &[usize]) -> Option<Vec<Box<dyn Contour>>> {
    let starts = std::iter::once(0).chain(vertices.iter().copied());
    let ends = vertices.iter().copied().chain([points.len().checked_sub(1)?]);
    let piece = |(from, to): (usize, usize)| -> Option<Box<dyn Contour>> {
        match points.get(from..=to)? {
            [from, to] => Some(Box::new(Line::new(*from, *to).ok()?)),
            points => Some(Box::new(Spline::through(points, SplineEnd::Natural).ok()?)),
        }
    };
    starts.zip(ends).map(piece).collect()
}

/// Smooth pieces between the vertices of a closed contour, whose last point is not its first.
fn closed_pieces(mut points: Vec<[f64; 2]>, vertices: &[usize]) -> Option<Vec<Box<dyn Contour>>> {
    let Some(first) = vertices.first() else {
        return Some(vec![Box::new(Spline::through(&points, SplineEnd::Periodic).ok()?)]);
    };
    points.rotate_left(*first);
    points.push(*points.first()?);
    pieces(&points, &vertices[1..].iter().map(|vertex| vertex - first).collect::<Vec<_>>())
}

/// The middle one of some values; 0 of none.
fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn arc(from: f64, to: f64, count: usize) -> FittedObject {
        let angle = |k: usize| from + (to - from) * k as f64 / (count - 1) as f64;
        FittedObject {
            points: (0..count).map(|k| [0.2 * angle(k).cos(), 0.2 * angle(k).sin()]).collect(),
            vertices: Vec::new(),
            known: vec![Knowledge::Touched { sigma: 1e-4 }; count],
        }
    }

    #[test]
    fn an_arc_goes_on_as_a_circle() {
        let all = Hypothesis::all(&[arc(-2.3, -0.8, 30)], 1.0, (4, 1), &|_| true);
        assert_eq!(all.len(), 5);
        let (object, outline, touched) = (&all[0].objects[0], &all[0].outlines[0], &all[0].touched[0]);
        // half of what is left of the circle on either side, less what stays open
        assert!((touched.length() - 0.2 * 1.5).abs() < 1e-4, "{}", touched.length());
        for (_, frame) in outline.points(object) {
            assert!((frame.x.hypot(frame.y) - 0.2).abs() < 5e-3, "{frame:?}");
        }
        assert!(outline.length() > 0.2 * 5.0);
    }

    #[test]
    fn what_lies_between_two_contours_is_not_touched() {
        // 0.6 rad of a circle on each side of a gap of 0.4 rad
        for one in Hypothesis::all(&[arc(-2.3, -1.7, 12), arc(-1.3, -0.7, 12)], 1.0, (2, 1), &|_| true) {
            assert_eq!(one.objects.len(), 1);
            assert!((one.touched[0].length() - 0.2 * 1.2).abs() < 1e-3, "{:?}", one.touched);
        }
    }

    #[test]
    fn bounded_points_that_contradict_each_other_do_not_hinder_what_was_touched() {
        // beyond the start of the arc and once in the middle the bounds of two scans overlap
        let mut contour = arc(-2.3, 4.4, 80);
        contour.known[..12].fill(Knowledge::Bounded { room: 0.01 });
        contour.known[36..44].fill(Knowledge::Bounded { room: 0.01 });
        contour.points.swap(38, 41);
        let all = Hypothesis::all(&[contour], 1.0, (2, 1), &|_| true);
        assert_eq!(all.len(), 3);
        let (outline, touched) = (&all[0].outlines[0], &all[0].touched[0]);
        // of the 79 steps, 12 before the touched points, and 9 in the middle
        let expected = 0.2 * 58.0 * 6.7 / 79.0;
        assert!(outline.is_closed() && (outline.length() - 0.4 * PI).abs() < 0.01, "{}", outline.length());
        assert!((touched.length() - expected).abs() < 1e-3, "{touched:?} {expected}");
    }

    /// As of scans whose fits disagree.
    #[test]
    fn touched_points_at_which_a_contour_crosses_itself_are_left_out() {
        let mut contour = arc(-2.3, 1.0, 50);
        contour.points.swap(20, 23);
        let all = Hypothesis::all(&[contour.clone()], 1.0, (2, 1), &|_| true);
        assert_eq!(all.len(), 3);
        let left_out = &all[0].left_out;
        let is_near = |one: &[f64; 2]| contour.points[19..25].contains(one);
        assert!((1..=4).contains(&left_out.len()) && left_out.iter().all(is_near), "{left_out:?}");
        // of the 49 steps
        let share = all[0].touched[0].length() / (0.2 * 3.3);
        assert!((43.9 / 49.0..=1.0).contains(&share), "{share}");
        let plain = Hypothesis::all(&[arc(-2.3, 1.0, 50)], 1.0, (0, 1), &|_| true);
        assert!(plain[0].left_out.is_empty());
    }

    /// What the rod has passed turns an end, so that it would cross the contour.
    #[test]
    fn ends_that_would_cross_the_contour_are_shorter() {
        // to the right along a line, then left and back
        let (count, radius) = (8, 0.025);
        let line = (0..=15).map(|k| [0.02 * f64::from(k), 0.0]);
        let turn = (1..=count).map(|k| PI * f64::from(k) / f64::from(count));
        let bow = turn.map(|angle| [0.3 + radius * angle.sin(), radius * (1.0 - angle.cos())]);
        let points: Vec<[f64; 2]> = line.chain(bow).collect();
        let known = vec![Knowledge::Touched { sigma: 1e-4 }; points.len()];
        let contour = FittedObject { vertices: vec![15], known, points };
        let all = Hypothesis::all(&[contour], 1.0, (0, 1), &|[x, y]| x > 0.28 || y < 0.02);
        assert_eq!((all.len(), all[0].left_out.len()), (1, 0));
        assert!((all[0].touched[0].length() - 0.3 - PI * radius).abs() < 1e-3, "{:?}", all[0].touched);
    }

    #[test]
    fn hollows_differ_and_what_is_touched_stays() {
        let mut contour = arc(-2.3, -0.8, 30);
        contour.known[10..15].fill(Knowledge::Bounded { room: 0.02 });
        let all = Hypothesis::all(&[contour.clone()], 1.0, (3, 7), &|_| true);
        for one in &all[1..] {
            let gap = |k: usize| one.objects[0].gap(contour.points[k][0], contour.points[k][1]);
            assert!(gap(12).abs() > 1e-6 && gap(12).abs() < 0.021 && gap(5).abs() < 1e-12);
            assert_eq!(one.touched[0].parts().len(), 2);
        }
    }
}
