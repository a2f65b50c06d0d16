//! Clouds of points in the plane, the true contour behind them, and what they mean.

use super::canvas::{Area, BODY, FigureError, HPos, stroke, width, write};
use super::chart::Chart;
use super::element::{Element, ShapeStyle};
use super::line::thin_line;
use super::outline;
use super::palette::{INK, RGBColor};
use super::plane::PlaneWindow;
use vibrissa::Composite;
use vibrissa::contour::Bounds;

/// Radius of a dot, width of the ring of an open one, least distance of two neighbours, pixels.
const RADIUS: i32 = 5;
const RING: u32 = 2;
const APART: f64 = 4.0;
/// Length of a dash and the gap behind it, pixels.
const DASH: (i32, i32) = (14, 9);
/// Room for a sample of the key, pixels.
const SAMPLE: i32 = 34;

/// How a dot looks.
#[derive(Clone, Copy)]
pub(crate) struct Dot {
    pub colour: RGBColor,
    pub filled: bool,
}

impl Dot {
    fn style(self) -> ShapeStyle {
        if self.filled { self.colour.filled() } else { self.colour.stroke_width(RING) }
    }
}

/// Draws points (mm) in order, without those that would hide behind the one before.
pub(crate) fn dots(
    chart: &Chart<'_>,
    window: &PlaneWindow,
    points: impl IntoIterator<Item = (f64, f64)>,
    dot: Dot,
) -> Result<(), FigureError> {
    let points = apart(points, APART * window.scale).into_iter();
    chart.draw_series(points.map(|point| Element::circle(point, RADIUS, dot.style())))?;
    Ok(())
}

/// The points that are at least so far from the one kept before.
fn apart(points: impl IntoIterator<Item = (f64, f64)>, least: f64) -> Vec<(f64, f64)> {
    let mut kept: Vec<(f64, f64)> = Vec::new();
    for (x, y) in points {
        if kept.last().is_none_or(|last| (last.0 - x).hypot(last.1 - y) >= least) {
            kept.push((x, y));
        }
    }
    kept
}

/// Draws the contours of objects (m), dashed.
pub(crate) fn contours(chart: &Chart<'_>, window: &PlaneWindow, objects: &[Composite]) -> Result<(), FigureError> {
    let PlaneWindow { x, y, scale } = window;
    let bounds = Bounds { min: [1e-3 * x.start, 1e-3 * y.start], max: [1e-3 * x.end, 1e-3 * y.end] };
    for part in objects.iter().flat_map(|object| outline::visible(object, bounds)) {
        let line = thin_line(part.iter().map(|frame| (1e3 * frame.x, 1e3 * frame.y)), (*scale, *scale));
        chart.draw_series([Element::dashed(line, (DASH.0, DASH.1), INK.stroke_width(2))])?;
    }
    Ok(())
}

/// Writes what dots mean, and, with a name for it, the dashed line, in one row from a point on.
pub(crate) fn key(
    area: &Area<'_>,
    (mut x, y): (i32, i32),
    entries: &[(Dot, &str)],
    dashed: Option<&str>,
) -> Result<(), FigureError> {
    for (dot, name) in entries {
        area.draw(&Element::circle((x + 14, y), RADIUS + 2, dot.style()))?;
        write(area, name, (x + SAMPLE, y), HPos::Left, BODY, INK)?;
        x += 2 * SAMPLE + width(name, BODY);
    }
    if let Some(name) = dashed {
        for start in [0, DASH.0 + DASH.1] {
            stroke(area, vec![(x + start, y), (x + start + DASH.0, y)], INK.stroke_width(2))?;
        }
        write(area, name, (x + 3 * DASH.0 + DASH.1, y), HPos::Left, BODY, INK)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_that_would_hide_are_left_out() {
        let row = (0..=100).map(|k| (0.1 * f64::from(k), 0.0));
        let kept = apart(row, 0.95);
        assert_eq!(kept.len(), 11);
        assert!(kept.windows(2).all(|pair| pair[1].0 - pair[0].0 >= 0.95));
        assert!(apart([], 1.0).is_empty());
    }
}
