//! The contour of several recordings.

use super::canvas::{FigureError, HPos, PAGE, TITLE, span, svg, write};
use super::cloud::{self, Dot};
use super::element::Element;
use super::line::thin_line;
use super::palette::{self, INK, RGBColor};
use super::plane::PlaneWindow;
use vibrissa::reconstruct::{ContourEstimate, Trace, TraceKind};

/// Width; least and largest height of the plot; height of the title and the key, pixels.
const WIDTH: u32 = PAGE;
const HEIGHT: (f64, f64) = (300.0, 1200.0);
const HEAD: u32 = 130;
/// Width of the lines, pixels.
const LINE: u32 = 3;

/// Each kind of stretch, with its colour and what it means.
const KINDS: [(TraceKind, RGBColor, &str); 3] = [
    (TraceKind::Single, INK, "one contact"),
    (TraceKind::First, palette::FIRST, "first of several"),
    (TraceKind::Second, palette::SECOND, "second of several"),
];

/// Draws the stretches of a contour in the plane.
pub(crate) fn merged(contour: &ContourEstimate) -> Result<String, FigureError> {
    let points = || contour.traces.iter().flat_map(millimetres);
    let (x, y) = (span(points().map(|point| point.0), 0.06), span(points().map(|point| point.1), 0.1));
    let (window, height) = PlaneWindow::as_wide_as(WIDTH, &x, &y, HEIGHT);
    svg((WIDTH, HEAD + height), |root| {
        let (head, area) = root.split_vertically(HEAD);
        write(&head, "contour of all recordings", (24, 36), HPos::Left, TITLE, INK)?;
        let drawn = KINDS.into_iter().filter(|kind| contour.of_kind(kind.0).next().is_some());
        let entries: Vec<(Dot, &str)> = drawn.map(|(_, colour, name)| (Dot { colour, filled: true }, name)).collect();
        cloud::key(&head, (24, 100), &entries, None)?;
        let chart = window.chart(&area, (12, 8))?;
        for (kind, colour, _) in KINDS {
            let line = |trace: &Trace| thin_line(millimetres(trace), (window.scale, window.scale));
            let lines = contour.of_kind(kind).map(line);
            chart.draw_series(lines.map(|line| Element::line(line, colour.stroke_width(LINE))))?;
        }
        Ok(())
    })
}

fn millimetres(trace: &Trace) -> impl Iterator<Item = (f64, f64)> + '_ {
    trace.points.iter().map(|point| (1e3 * point.x, 1e3 * point.y))
}
