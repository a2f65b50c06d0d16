//! A contour, drawn with the side on which the solid is.

use super::canvas::FigureError;
use super::chart::Chart;
use super::element::Element;
use super::line::thin_line;
use super::outline;
use super::palette::{INK, MUTED, SOLID};
use super::plane::PlaneWindow;
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2, PI};
use vibrissa::Composite;
use vibrissa::contour::{Bounds, Frame};

/// Width of the line, pixels.
pub(super) const WIDTH: u32 = 5;
/// Distance of the strokes into the solid, and their length, pixels.
const APART: f64 = 22.0;
const STROKE: f64 = 20.0;

/// Fills a closed object that the window (m) shows as a whole: strokes in a small one would cross each other.
pub(super) fn fill(chart: &Chart<'_>, object: &Composite, bounds: Bounds) -> Result<(), FigureError> {
    let Some(frames) = seen_whole(object, bounds) else { return Ok(()) };
    chart.draw_series([Element::polygon(frames.iter().map(millimetres), SOLID.filled())])
}

/// Draws the contour of an object in the window (m), with strokes into the solid where [`fill`] does not fill it.
pub(super) fn draw_object(
    chart: &Chart<'_>,
    window: &PlaneWindow,
    object: &Composite,
    bounds: Bounds,
) -> Result<(), FigureError> {
    if let Some(frames) = seen_whole(object, bounds) {
        let line = thin_line(frames.iter().map(millimetres), (window.scale, window.scale));
        return chart.draw_series([Element::line(line, INK.stroke_width(WIDTH))]);
    }
    for part in outline::visible(object, bounds) {
        draw(chart, window, part.iter().map(millimetres))?;
    }
    Ok(())
}

/// A closed object that the window (m) shows as a whole. A cavity is none: its solid lies outside of it.
fn seen_whole(object: &Composite, bounds: Bounds) -> Option<Vec<Frame>> {
    (!object.is_cavity()).then(|| outline::seen_whole(object, bounds)).flatten()
}

fn millimetres(frame: &Frame) -> (f64, f64) {
    (1e3 * frame.x, 1e3 * frame.y)
}

/// Draws a part of a contour (mm), and those strokes into the solid that end in the window.
pub(super) fn draw(
    chart: &Chart<'_>,
    window: &PlaneWindow,
    part: impl IntoIterator<Item = (f64, f64)>,
) -> Result<(), FigureError> {
    let line = thin_line(part, (window.scale, window.scale));
    let seen = |stroke: &[(f64, f64); 2]| window.x.contains(&stroke[1].0) && window.y.contains(&stroke[1].1);
    let strokes = hatching(&line, window.scale).into_iter().filter(seen);
    chart.draw_series(strokes.map(|stroke| Element::line(stroke, MUTED.stroke_width(2))))?;
    chart.draw_series([Element::line(line, INK.stroke_width(WIDTH))])?;
    Ok(())
}

/// Strokes (mm) from the contour into the solid, slanted backwards.
fn hatching(line: &[(f64, f64)], scale: f64) -> Vec<[(f64, f64); 2]> {
    let (apart_by, length) = (APART * scale, STROKE * scale);
    let mut strokes = Vec::new();
    let angle = |chord: &[(f64, f64)]| (chord[1].1 - chord[0].1).atan2(chord[1].0 - chord[0].0);
    let mut ahead = clear(FRAC_PI_2) * length;
    // Where the contour is closed its start is a corner too.
    let mut before = line.windows(2).last().filter(|_| line.first() == line.last()).map(angle);
    for chord in line.windows(2) {
        let (from, angle) = (chord[0], angle(chord));
        let chord = (chord[1].0 - from.0).hypot(chord[1].1 - from.1);
        ahead = before.replace(angle).map_or(ahead, |before| ahead.max(clear(angle - before) * length));
        while ahead < chord {
            let place = (from.0 + ahead * angle.cos(), from.1 + ahead * angle.sin());
            let (sin, cos) = (angle + 0.75 * PI).sin_cos();
            strokes.push([place, (place.0 + length * cos, place.1 + length * sin)]);
            ahead += apart_by;
        }
        ahead -= chord;
    }
    strokes
}

/// Least distance, in lengths of a stroke, from a corner where the contour turns by an angle: nearer to a convex one a
/// stroke would come out on its other side.
fn clear(turn: f64) -> f64 {
    let (sin, cos) = turn.sin_cos();
    if sin > 0.0 { FRAC_1_SQRT_2 * (1.0 - cos / sin) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strokes_stand_evenly_and_in_the_solid() {
        let strokes = hatching(&[(0.0, 0.0), (33.0, 0.0), (100.0, 0.0)], 1.0);
        let places: Vec<f64> = strokes.iter().map(|stroke| stroke[0].0).collect();
        assert_eq!(places.len(), 4);
        assert!(places.windows(2).all(|pair| (pair[1] - pair[0] - APART).abs() < 1e-9), "{places:?}");
        assert!(strokes.iter().all(|stroke| stroke[1].1 > 0.0), "the solid is above a line to the right");
    }

    #[test]
    fn strokes_beside_a_corner_stay_in_the_solid() {
        let corners = [(0.0, 0.0), (200.0, 0.0), (60.0, 150.0), (0.0, 0.0)];
        for (tip, chord) in
            hatching(&corners, 1.0).iter().flat_map(|[_, tip]| corners.windows(2).map(move |c| (tip, c)))
        {
            let [from, to] = [chord[0], chord[1]];
            let left = (to.0 - from.0) * (tip.1 - from.1) - (to.1 - from.1) * (tip.0 - from.0);
            assert!(left > -1e-9, "{tip:?} beside {chord:?}");
        }
    }
}
