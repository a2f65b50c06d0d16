//! Contours, drawn with the side on which the solid is.

use super::canvas::{FigureError, TITLE, span, svg, write};
use super::palette::{INK, MUTED};
use super::plane::Window;
use crate::Profile;
use plotters::prelude::*;
use plotters::style::text_anchor::HPos;
use std::f64::consts::PI;
use std::ops::Range;

/// Width of the picture and bounds of its height, pixels.
const WIDTH: u32 = 1200;
const HEIGHT: Range<f64> = 420.0..1500.0;
/// Room for the title, pixels.
const HEAD: u32 = 70;
/// Distance of the strokes into the solid, and their length, pixels.
const APART: f64 = 22.0;
const STROKE: f64 = 20.0;
/// Turn (rad) beyond which a corner is seen as one, and the distance of the first stroke from it, in lengths of a stroke.
const SMOOTH: f64 = 0.3;
const CLEAR: f64 = 0.75;
/// Least distance of two points that are drawn, pixels; the canvas knows whole ones only.
const FINEST: f64 = 3.0;
/// Radius of the marks where pieces meet, and their least distance, pixels.
const MARK: i32 = 6;
const MARKS: f64 = 18.0;

/// Draws the contours of a scene.
pub(crate) fn profile(name: &str, profiles: &[Profile]) -> Result<String, FigureError> {
    let all = || profiles.iter().flat_map(|profile| &profile.points);
    let x = span(all().map(|point| 1e3 * point.x), 0.06);
    let y = span(all().map(|point| 1e3 * point.y), 0.06);
    let (beside, below) = Window::TRIMMINGS;
    let (plot, trimmings) = (f64::from(WIDTH - beside), f64::from(below + HEAD));
    let height = (plot * (y.end - y.start) / (x.end - x.start) + trimmings).clamp(HEIGHT.start, HEIGHT.end).round();
    let window = Window::of(&x, &y, (plot, height - trimmings));
    let scale = window.scale;
    svg((WIDTH, height as u32), |root| {
        let (head, body) = root.split_vertically(HEAD);
        write(&head, name, (24, 36), HPos::Left, TITLE, INK)?;
        let mut chart = window.chart(&body, (12, 10))?;
        for profile in profiles {
            let line = visible(profile, FINEST * scale);
            chart.draw_series(
                hatching(&line, scale).into_iter().map(|stroke| PathElement::new(stroke, MUTED.stroke_width(2))),
            )?;
            chart.draw_series([PathElement::new(line, INK.stroke_width(4))])?;
            let marks = marks(&profile.joints, MARKS * scale);
            chart.draw_series(marks.iter().map(|mark| Circle::new(*mark, MARK, WHITE.filled())))?;
            chart.draw_series(marks.iter().map(|mark| Circle::new(*mark, MARK, INK.stroke_width(3))))?;
        }
        Ok(())
    })
}

/// The points (mm) that a reader can tell apart: those `finest` (mm) from the last one, and all that stand at the end of a chord
/// longer than that.
fn visible(profile: &Profile, finest: f64) -> Vec<(f64, f64)> {
    let mut line: Vec<(f64, f64)> = Vec::new();
    let mut skipped = None;
    for point in &profile.points {
        let point = (1e3 * point.x, 1e3 * point.y);
        let far = |from: Option<&(f64, f64)>| from.is_none_or(|from| apart(*from, point) >= finest);
        // A corner is where a long chord ends, even if the chord before it was short.
        if far(skipped.as_ref().or(line.last())) {
            line.extend(skipped.take());
            line.push(point);
        } else if far(line.last()) {
            line.push(point);
            skipped = None;
        } else {
            skipped = Some(point);
        }
    }
    line.extend(skipped);
    line
}

/// The joints (mm) that are at least so far (mm) from the one before; none where most are nearer, as on a fine polygon.
fn marks(joints: &[[f64; 2]], least: f64) -> Vec<(f64, f64)> {
    let mut marks: Vec<(f64, f64)> = Vec::new();
    for [x, y] in joints {
        let joint = (1e3 * x, 1e3 * y);
        if marks.last().is_none_or(|last| apart(*last, joint) >= least) {
            marks.push(joint);
        }
    }
    if 2 * marks.len() < joints.len() { Vec::new() } else { marks }
}

/// Strokes (mm) from the contour into the solid, slanted backwards.
fn hatching(line: &[(f64, f64)], scale: f64) -> Vec<Vec<(f64, f64)>> {
    let (apart_by, length) = (APART * scale, STROKE * scale);
    let mut strokes = Vec::new();
    let (mut ahead, mut before): (f64, Option<f64>) = (0.0, None);
    for chord in line.windows(2) {
        let [from, to] = [chord[0], chord[1]];
        let (chord, angle) = (apart(from, to), (to.1 - from.1).atan2(to.0 - from.0));
        // Nearer to a corner a stroke would come out on its other side.
        if before.is_none_or(|before| (angle - before).cos() < SMOOTH.cos()) {
            ahead = ahead.max(CLEAR * length);
        }
        before = Some(angle);
        while ahead < chord {
            let place = (from.0 + ahead * angle.cos(), from.1 + ahead * angle.sin());
            let (sin, cos) = (angle + 0.75 * PI).sin_cos();
            strokes.push(vec![place, (place.0 + length * cos, place.1 + length * sin)]);
            ahead += apart_by;
        }
        ahead -= chord;
    }
    strokes
}

fn apart(one: (f64, f64), other: (f64, f64)) -> f64 {
    (other.0 - one.0).hypot(other.1 - one.1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn joints_too_near_to_be_told_apart_are_not_marked() {
        let joints = |apart: f64| (0..100).map(|k| [1e-3 * apart * f64::from(k), 0.0]).collect::<Vec<_>>();
        assert_eq!(marks(&joints(1.0), 0.9).len(), 100);
        assert!(marks(&joints(1.0), 2.5).is_empty());
    }

    #[test]
    fn strokes_stand_evenly_and_in_the_solid() {
        let strokes = hatching(&[(0.0, 0.0), (33.0, 0.0), (100.0, 0.0)], 1.0);
        let places: Vec<f64> = strokes.iter().map(|stroke| stroke[0].0).collect();
        assert_eq!(places.len(), 4);
        assert!(places.windows(2).all(|pair| (pair[1] - pair[0] - APART).abs() < 1e-9), "{places:?}");
        assert!(strokes.iter().all(|stroke| stroke[1].1 > 0.0), "the solid is above a line to the right");
    }
}
