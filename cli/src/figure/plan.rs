//! What is known of a contour, the hypotheses about it, and the scans to make next.

use super::canvas::{BODY, FigureError, HPos, PAGE, TITLE, span, stroke, svg, width, write};
use super::element::Element;
use super::line::thin_line;
use super::palette::{FAINT, INK, MUTED, OTHERS, RGBColor};
use super::plane::PlaneWindow;
use rod_files::{Approaches, Planned};
use std::sync::Arc;
use vibrissa::contact::Path;
use vibrissa::plan::{Choice, Outline};
use vibrissa::reconstruct::Knowledge;

/// Height of title and legend, and of the plane (from, to), pixels.
const HEAD: u32 = 116;
const PLANE: (f64, f64) = (500.0, 1300.0);
/// Radius of a point, pixels.
const POINT: f64 = 5.0;
/// Length of the arrow that shows the rod, in lengths of the path.
const ROD: f64 = 0.08;

/// Distance of the number of a scan from where it begins, pixels.
const NUMBER: f64 = 26.0;

/// Points of a path that is drawn.
const PARTS: usize = 40;

/// What is drawn: lines of contours (mm), points with what is known there, and paths of the clamp.
struct Drawing<'a> {
    title: String,
    entries: &'a [(RGBColor, &'static str)],
    lines: Vec<Vec<(f64, f64)>>,
    points: Vec<((f64, f64), RGBColor)>,
    paths: Vec<Arc<dyn Path>>,
}

fn mm([x, y]: [f64; 2]) -> (f64, f64) {
    (1e3 * x, 1e3 * y)
}

/// The entry of the legend for the paths.
const CLAMP: (RGBColor, &str) = (OTHERS[0], "clamp, with the rod's direction");

/// Draws hypotheses, known points and the chosen paths of the clamp.
pub(crate) fn plan(found: &Planned) -> Result<String, FigureError> {
    let outlines =
        found.plan.hypotheses.iter().flat_map(|hypothesis| hypothesis.objects.iter().zip(&hypothesis.outlines));
    let line = |(object, outline): (_, &Outline)| {
        outline.points(object).map(|(_, frame)| mm([frame.x, frame.y])).collect::<Vec<_>>()
    };
    let colour = |known: &Knowledge| match known {
        Knowledge::Touched { .. } => INK,
        Knowledge::Bounded { .. } => OTHERS[1],
        Knowledge::Unknown => MUTED,
    };
    let points = found.known.iter().flat_map(|contour| contour.points.iter().zip(&contour.known));
    let path = |choice: &Choice| found.plan.forecasts[choice.candidate].candidate.path.clone();
    drawn(&Drawing {
        title: format!("{}: the next scans", found.name),
        entries: &[(INK, "touched"), (OTHERS[1], "bounded"), (MUTED, "unknown"), (FAINT, "hypotheses"), CLAMP],
        lines: outlines.map(line).collect(),
        points: points.map(|(point, known)| (mm(*point), colour(known))).collect(),
        paths: found.choices.iter().map(path).collect(),
    })
}

/// Draws a box around an object, and the paths of the clamp to it.
pub(crate) fn approaches(found: &Approaches) -> Result<String, FigureError> {
    let corners = found.bounds.corners().map(mm);
    drawn(&Drawing {
        title: "The first scans".to_owned(),
        entries: &[(FAINT, "box"), CLAMP],
        lines: vec![corners.into_iter().chain([corners[0]]).collect()],
        points: Vec::new(),
        paths: found.scans.iter().map(|(path, _)| Arc::new(*path) as Arc<dyn Path>).collect(),
    })
}

fn drawn(drawing: &Drawing<'_>) -> Result<String, FigureError> {
    let Drawing { title, entries, lines, points, paths } = drawing;
    let way = |path: &Arc<dyn Path>| -> Vec<(f64, f64)> {
        let pose = |part: usize| path.point(path.length() * part as f64 / PARTS as f64).pose;
        (0..=PARTS).map(pose).map(|pose| mm([pose.x, pose.y])).collect()
    };
    let ways: Vec<Vec<(f64, f64)>> = paths.iter().map(way).collect();
    let extent = if points.is_empty() { lines.as_slice() } else { &[] };
    let all = || points.iter().map(|point| point.0).chain(ways.iter().chain(extent).flatten().copied());
    let (x, y) = (span(all().map(|point| point.0), 0.08), span(all().map(|point| point.1), 0.08));
    let (window, height) = PlaneWindow::as_wide_as(PAGE, &x, &y, PLANE);
    svg((PAGE, HEAD + height), |root| {
        let (head, body) = root.split_vertically(HEAD);
        write(&head, title, (24, 36), HPos::Left, TITLE, INK)?;
        let mut left = 24;
        for (colour, name) in *entries {
            stroke(&head, vec![(left, 84), (left + 44, 84)], colour.stroke_width(6))?;
            write(&head, name, (left + 56, 84), HPos::Left, BODY, INK)?;
            left += 56 + width(name, BODY) + 30;
        }
        let chart = window.chart(&body, (12, 10))?;
        for line in lines {
            let line = thin_line(line.iter().copied(), (window.scale, window.scale));
            chart.draw_series([Element::line(line, FAINT.stroke_width(2))])?;
        }
        for (point, colour) in points {
            chart.draw_series([Element::circle(*point, POINT, colour.filled())])?;
        }
        for (place, (path, way)) in paths.iter().zip(&ways).enumerate() {
            let line = thin_line(way.iter().copied(), (window.scale, window.scale));
            chart.draw_series([Element::line(line, OTHERS[0].stroke_width(4))])?;
            let [from, to] = [0.0, path.length()].map(|way| path.point(way).pose);
            let rod = ROD * path.length();
            let tip = mm([from.x + rod * from.phi.cos(), from.y + rod * from.phi.sin()]);
            chart.draw_series([Element::line([way[0], tip], OTHERS[0].stroke_width(4))])?;
            // between the extensions of both lines
            let (sin, cos) = from.phi.sin_cos();
            let apart = (to.x - from.x).hypot(to.y - from.y).max(f64::MIN_POSITIVE);
            let along = [(to.x - from.x) / apart + cos, (to.y - from.y) / apart + sin];
            let pixels = |along: f64| (NUMBER * along / 2.0_f64.sqrt()).round() as i32;
            let at = chart.backend_coord(&way[0]);
            let at = (at.0 - pixels(along[0]), at.1 + pixels(along[1]));
            write(root, &(place + 1).to_string(), at, HPos::Center, BODY, OTHERS[0])?;
        }
        Ok(())
    })
}
