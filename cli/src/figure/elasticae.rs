//! The contour and the shapes of the rod along a scan.

use super::canvas::{Area, BODY, FigureError, HPos, span, width, write};
use super::chart::Chart;
use super::contour;
use super::element::Element;
use super::labels::Labels;
use super::line::thin_line;
use super::outline;
use super::palette::{INK, TRANSITION, WHITE, colour};
use super::plane::PlaneWindow;
use super::support;
use rod_files::{Interval, Scan};
use std::f64::consts::{FRAC_PI_2, PI};
use vibrissa::State;
use vibrissa::contact::{EventKind, Phase};
use vibrissa::contour::Bounds;
use vibrissa::rod::{AnyRod, RodError};

/// Most shapes drawn, besides those at transitions.
const MOST: usize = 60;
/// Points on a shape.
const POINTS: usize = 200;
/// Room beside and above the shapes, for the names of phases, pixels.
const ROOM: (f64, f64) = (50.0, 100.0);

/// Least gap between two names in a row, pixels: two names closer read as one.
const APART: i32 = 14;

/// From this cosine between the rod at its clamp and the path on, the clamp moves along the rod.
const LENGTHWISE: f64 = 0.8;

type Curve = Vec<(f64, f64)>;

/// Height (pixels) at which the shapes fill an area of this width.
pub(super) fn height(scan: &Scan, width: u32) -> Result<f64, FigureError> {
    let every = scan.outcome.states.len().div_ceil(MOST).max(1);
    let mut seen = clamps(scan);
    for state in scan.outcome.states.iter().step_by(every) {
        seen.extend(curve(state, &scan.scene.rod)?);
    }
    let seen = with_closed_objects(scan, seen);
    let [x, y] = [span(seen.iter().map(|point| point.0), 0.0), span(seen.iter().map(|point| point.1), 0.0)];
    let (beside, below) = PlaneWindow::TRIMMINGS;
    let plot = f64::from(width.saturating_sub(beside)) - 2.0 * ROOM.0;
    Ok(plot * (y.end - y.start) / (x.end - x.start) + 2.0 * ROOM.1 + f64::from(below))
}

/// Where the clamp starts, turns and ends, mm.
fn clamps(scan: &Scan) -> Curve {
    scan.scene.poses().into_iter().map(|pose| (1e3 * pose.x, 1e3 * pose.y)).collect()
}

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
    let seen = shapes.iter().map(|(curve, _)| curve).chain(&transitions).flatten().copied();
    let seen: Curve = seen.chain(clamps(scan)).collect();
    let seen = with_closed_objects(scan, seen);
    let window = window(area, &seen);
    let chart = window.chart(area, (12, 12))?;
    let PlaneWindow { x, y, .. } = &window;
    let bounds = Bounds { min: [1e-3 * x.start, 1e-3 * y.start], max: [1e-3 * x.end, 1e-3 * y.end] };
    for object in &scan.scene.objects {
        contour::fill(&chart, object, bounds)?;
    }
    let line = |curve: Curve| thin_line(curve, (window.scale, window.scale));
    chart.draw_series(shapes.into_iter().map(|(curve, style)| Element::line(line(curve), style)))?;
    chart.draw_series(transitions.into_iter().map(|curve| Element::line(line(curve), TRANSITION.stroke_width(3))))?;
    for curve in landings {
        chart.draw_series([Element::dashed(line(curve), (14, 10), TRANSITION.stroke_width(3))])?;
    }
    for object in &scan.scene.objects {
        contour::draw_object(&chart, &window, object, bounds)?;
    }
    let mut drawn = scan.outcome.states.iter().step_by(every);
    for state in drawn.next().into_iter().chain(drawn.next_back()) {
        support::draw(&chart, &window, rod, state)?;
    }
    name_phases(root, &chart, scan, &intervals)
}

/// The points (mm), and those of closed objects that are not much larger than what they span.
fn with_closed_objects(scan: &Scan, mut seen: Curve) -> Curve {
    let [x, y] = [span(seen.iter().map(|point| point.0), 0.0), span(seen.iter().map(|point| point.1), 0.0)];
    let more = (x.end - x.start).max(y.end - y.start);
    let around = |range: &std::ops::Range<f64>| (1e-3 * (range.start - more), 1e-3 * (range.end + more));
    let ((left, right), (bottom, top)) = (around(&x), around(&y));
    let window = Bounds { min: [left, bottom], max: [right, top] };
    for object in scan.scene.objects.iter().filter(|object| object.is_closed()) {
        let frames = outline::seen_whole(object, window).into_iter().flatten();
        seen.extend(frames.map(|frame| (1e3 * frame.x, 1e3 * frame.y)));
    }
    seen
}

/// The states before all transitions, and those after snaps. A slip within a phase is none, here as along the
/// reactions: on a fine polygon there is one at each vertex.
fn transitions<'a>(intervals: &[Interval<'a>]) -> (Vec<&'a State>, Vec<&'a State>) {
    let before = intervals.iter().filter(|interval| interval.end.is_some());
    let after = intervals.windows(2).filter(|pair| pair[0].end == Some(EventKind::Snap));
    (
        before.filter_map(|interval| interval.states.last().copied()).collect(),
        after.filter_map(|pair| pair[1].states.first().copied()).collect(),
    )
}

/// The shape of the rod in mm.
fn curve(state: &State, rod: &AnyRod) -> Result<Curve, RodError> {
    Ok(state.elastica(rod)?.sample(POINTS).map(|section| (1e3 * section.x, 1e3 * section.y)).collect())
}

/// A window on all points (mm).
fn window(area: &Area<'_>, points: &[(f64, f64)]) -> PlaneWindow {
    let (width, height) = area.dim_in_pixel();
    let (beside, below) = PlaneWindow::TRIMMINGS;
    let plot = (f64::from(width.saturating_sub(beside).max(1)), f64::from(height.saturating_sub(below).max(1)));
    let x = span(points.iter().map(|point| point.0), 0.0);
    let y = span(points.iter().map(|point| point.1), 0.0);
    PlaneWindow::of(&x, &y, plot, ROOM)
}

/// Where the name of an interval goes (m), and the direction (rad) in which it keeps off: behind the clamp, in the
/// middle of the interval; where the clamp moves along the rod, beside it; where it only turns, off the tip and the
/// solid.
fn place(scan: &Scan, interval: &Interval<'_>, middle: &State) -> Result<((f64, f64), f64), RodError> {
    let (path, from, to) = (&scan.scene.path, interval.from, interval.to);
    if path.turns_only() {
        let rod = middle.elastica(&scan.scene.rod)?;
        let tip = rod.at(rod.length());
        return Ok(((tip.x, tip.y), middle.contacts.last().map_or(tip.phi, |contact| contact.alpha - FRAC_PI_2)));
    }
    let (rate, phi) = (path.rate(), 0.5 * (from.phi + to.phi));
    let lengthwise = (rate.x * phi.cos() + rate.y * phi.sin()).abs() > LENGTHWISE;
    // Where m0z is positive the rod bends to the right at its clamp.
    let away = if lengthwise { FRAC_PI_2.copysign(middle.reactions.m0z) } else { PI };
    Ok(((0.5 * (from.x + to.x), 0.5 * (from.y + to.y)), phi + away))
}

/// Writes each phase where it was.
fn name_phases(root: &Area<'_>, chart: &Chart<'_>, scan: &Scan, intervals: &[Interval<'_>]) -> Result<(), FigureError> {
    // a clamp that goes to and fro has several phases at one place
    if !scan.scene.legs.is_empty() {
        return Ok(());
    }
    let mut labels = Labels::default();
    for interval in intervals.iter().filter(|interval| interval.phase != Phase::FREE) {
        let Some(middle) = interval.middle() else { continue };
        let ((x, y), away) = place(scan, interval, middle)?;
        let (x, y) = chart.backend_coord(&(1e3 * x, 1e3 * y));
        let name = interval.phase.to_string();
        let size = (width(&name, BODY) + APART, BODY as i32 + 2);
        let (sin, cos) = away.sin_cos();
        let beside = 0.5 * f64::from(size.0) * cos;
        let places = [22.0, 48.0, 74.0].map(|d| (x + (d * cos + beside) as i32, y - (d * sin) as i32));
        if let Some(place) = labels.place(places, size) {
            // Shapes may pass behind it.
            let corners = [-1, 1].map(|side| (place.0 + side * size.0 / 2, place.1 + side * size.1 / 2));
            root.draw(&Element::rectangle(corners, WHITE.filled().mix(0.8)))?;
            write(root, &name, place, HPos::Center, BODY, INK)?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample::{along, event, outcome};
    use rod_files::intervals;

    #[test]
    fn slips_and_new_pieces_within_a_phase_are_no_transitions() {
        use EventKind::{FirstContact, Piece, Slip, Snap, SnapOff};
        let within = [(2.0, Slip), (3.0, Piece), (4.0, Slip)].map(|(x, kind)| event(x, "A", "A", kind));
        let mut events = vec![event(1.0, "free", "A", FirstContact)];
        events.extend(within);
        events.extend([event(5.0, "A", "A", Snap), event(6.0, "A", "free", SnapOff)]);
        let outcome = outcome(&[(0.0, "free"), (2.5, "A"), (5.5, "A"), (7.0, "free")], events);
        let (before, after) = transitions(&intervals(along, &outcome));
        let places = |states: Vec<&State>| states.iter().map(|state| state.pose.x).collect::<Vec<_>>();
        assert_eq!((places(before), places(after)), (vec![1.0, 5.0, 6.0], vec![5.0]));
    }
}
