//! The contour and the shapes of the rod along a scan.

use super::canvas::{Area, BODY, Chart, FigureError, span, width, write};
use super::labels::Labels;
use super::outline;
use super::palette::{INK, MUTED, colour};
use super::plane::Window;
use crate::{Interval, Scan};
use plotters::prelude::*;
use plotters::style::text_anchor::HPos;
use std::f64::consts::{FRAC_PI_2, PI};
use vibrissa::{Bounds, EventKind, Frame, Phase, Rod, RodError, State};

/// Most shapes drawn, besides those at transitions.
const MOST: usize = 60;
/// Points on a shape.
const POINTS: usize = 60;

type Curve = Vec<(f64, f64)>;

/// Draws the left half of a sweep's figure into a part of `root`.
pub(super) fn draw(root: &Area<'_>, area: &Area<'_>, scan: &Scan) -> Result<(), FigureError> {
    let (rod, intervals) = (&scan.scene.rod, scan.intervals());
    let every = scan.outcome.states.len().div_ceil(MOST).max(1);
    let mut shapes = Vec::new();
    for state in scan.outcome.states.iter().step_by(every) {
        shapes.push((curve(state, rod)?, colour(state.phase()).stroke_width(2)));
    }
    let (before, after) = transitions(&intervals);
    let curves = |states: Vec<&State>| states.into_iter().map(|state| curve(state, rod)).collect::<Result<Vec<_>, _>>();
    let (transitions, landings) = (curves(before)?, curves(after)?);
    let clamps = [0.0, scan.scene.path.length()].map(|way| scan.scene.path.at(way));
    let seen = shapes.iter().map(|(curve, _)| curve).chain(&transitions).flatten().copied();
    let seen: Curve = seen.chain(clamps.map(|pose| (1e3 * pose.x, 1e3 * pose.y))).collect();
    let window = window(area, &seen);
    let mut chart = window.chart(area, (12, 12))?;
    chart.draw_series(shapes.into_iter().map(|(curve, style)| PathElement::new(curve, style)))?;
    chart.draw_series(transitions.into_iter().map(|curve| PathElement::new(curve, INK.stroke_width(3))))?;
    for curve in landings {
        chart.draw_series(DashedLineSeries::new(curve, 14, 10, INK.stroke_width(3)))?;
    }
    draw_contour(&mut chart, scan, &window)?;
    name_phases(root, &chart, scan, &intervals)
}

/// The states before all transitions, and those after snaps. A slip within a phase is none, here as along the reactions: on a
/// fine polygon there is one at each vertex.
fn transitions<'a>(intervals: &[Interval<'a>]) -> (Vec<&'a State>, Vec<&'a State>) {
    let before = intervals.iter().filter(|interval| interval.end.is_some());
    let after = intervals.windows(2).filter(|pair| pair[0].end == Some(EventKind::Snap));
    (
        before.filter_map(|interval| interval.states.last().copied()).collect(),
        after.filter_map(|pair| pair[1].states.first().copied()).collect(),
    )
}

/// The shape of the rod in mm.
fn curve(state: &State, rod: &Rod) -> Result<Curve, RodError> {
    Ok(state.elastica(rod)?.sample(POINTS).map(|section| (1e3 * section.x, 1e3 * section.y)).collect())
}

/// A window on all points (mm).
fn window(area: &Area<'_>, points: &[(f64, f64)]) -> Window {
    let (width, height) = area.dim_in_pixel();
    let (beside, below) = Window::TRIMMINGS;
    let plot = (f64::from(width.saturating_sub(beside).max(1)), f64::from(height.saturating_sub(below).max(1)));
    let x = span(points.iter().map(|point| point.0), 0.06);
    let y = span(points.iter().map(|point| point.1), 0.12);
    Window::of(&x, &y, plot)
}

/// The contour with short strokes into the solid.
fn draw_contour(chart: &mut Chart<'_, '_>, scan: &Scan, Window { x, y, .. }: &Window) -> Result<(), FigureError> {
    let window = Bounds { min: [1e-3 * x.start, 1e-3 * y.start], max: [1e-3 * x.end, 1e-3 * y.end] };
    let distance = 0.016 * (x.end - x.start);
    for part in scan.scene.objects.iter().flat_map(|object| outline::visible(object, window)) {
        let mut since = distance;
        for (frame, next) in part.iter().zip(&part[1..]) {
            since += 1e3 * (next.x - frame.x).hypot(next.y - frame.y);
            let hatch = hatch(frame, distance);
            if since >= distance && window.contains(1e-3 * hatch[1].0, 1e-3 * hatch[1].1) {
                chart.draw_series([PathElement::new(hatch, MUTED.stroke_width(2))])?;
                since = 0.0;
            }
        }
        let points = part.iter().map(|frame| (1e3 * frame.x, 1e3 * frame.y));
        chart.draw_series(LineSeries::new(points, INK.stroke_width(5)))?;
    }
    Ok(())
}

/// A stroke (mm) from the contour into the solid, slanted backwards.
fn hatch(frame: &Frame, length: f64) -> Curve {
    let (sin, cos) = (frame.alpha + 0.75 * PI).sin_cos();
    let (x, y) = (1e3 * frame.x, 1e3 * frame.y);
    vec![(x, y), (x + length * cos, y + length * sin)]
}

/// Writes each phase behind the clamp, in the middle of its interval; where the clamp only turns, off the tip and the
/// solid.
fn name_phases(
    root: &Area<'_>,
    chart: &Chart<'_, '_>,
    scan: &Scan,
    intervals: &[Interval<'_>],
) -> Result<(), FigureError> {
    let mut labels = Labels::default();
    for interval in intervals.iter().filter(|interval| interval.phase != Phase::FREE) {
        let (from, to) = (interval.from, interval.to);
        let middle = (500.0 * (from.x + to.x), 500.0 * (from.y + to.y));
        let ((x, y), away) = match interval.middle() {
            Some(state) if scan.scene.path.turns_only() => {
                let elastica = state.elastica(&scan.scene.rod)?;
                let tip = elastica.at(elastica.length());
                let away = state.contacts.last().map_or(tip.phi, |contact| contact.alpha - FRAC_PI_2);
                (chart.backend_coord(&(1e3 * tip.x, 1e3 * tip.y)), away)
            }
            _ => (chart.backend_coord(&middle), 0.5 * (from.phi + to.phi) + PI),
        };
        let (sin, cos) = away.sin_cos();
        let places = [22.0, 48.0, 74.0].map(|d| (x + (d * cos) as i32, y - (d * sin) as i32));
        let name = interval.phase.to_string();
        let size = (width(&name, BODY) + 4, BODY as i32 + 2);
        if let Some(place) = labels.place(places, size) {
            // Shapes may pass behind it.
            let corners = [-1, 1].map(|side| (place.0 + side * size.0 / 2, place.1 + side * size.1 / 2));
            root.draw(&Rectangle::new(corners, WHITE.mix(0.8).filled()))?;
            write(root, &name, place, HPos::Center, BODY, INK)?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interval::intervals;
    use crate::sample::{event, outcome, path};

    #[test]
    fn slips_and_new_pieces_within_a_phase_are_no_transitions() {
        use EventKind::{FirstContact, Piece, Slip, Snap, SnapOff};
        let within = [(2.0, Slip), (3.0, Piece), (4.0, Slip)].map(|(x, kind)| event(x, "A", "A", kind));
        let mut events = vec![event(1.0, "free", "A", FirstContact)];
        events.extend(within);
        events.extend([event(5.0, "A", "A", Snap), event(6.0, "A", "free", SnapOff)]);
        let outcome = outcome(&[(0.0, "free"), (2.5, "A"), (5.5, "A"), (7.0, "free")], events);
        let (before, after) = transitions(&intervals(&path(), &outcome));
        let places = |states: Vec<&State>| states.iter().map(|state| state.pose.x).collect::<Vec<_>>();
        assert_eq!((places(before), places(after)), (vec![1.0, 5.0, 6.0], vec![5.0]));
    }
}
