//! The contour of a fit: where it is touched, and how far the object may reach beyond it where it is not.

use super::canvas::FigureError;
use super::chart::Chart;
use super::element::Element;
use super::palette::{FAINT, MUTED};
use vibrissa::reconstruct::{ContourFit, Knowledge};

/// Places between two points of the contour.
const PLACES: usize = 12;
/// Width of the line, and lengths of a dash and the gap behind it where nothing is touched, pixels.
const WIDTH: u32 = 3;
const DASH: (i32, i32) = (3, 5);

/// What is drawn.
pub(super) fn note(fit: &ContourFit) -> String {
    let which = if fit.goodness.explains { "contour of the fit" } else { "best contour, which explains only a part" };
    format!("grey line: {which}, dotted where untouched; pale: as far as the object may reach there")
}

/// Draws it: a line where it is touched, dots where it is not, and a pale area as far as the object may reach there at most.
pub(super) fn draw(chart: &Chart<'_>, fit: &ContourFit) -> Result<(), FigureError> {
    for object in &fit.objects {
        let intervals = object.intervals(PLACES).unwrap_or_default();
        for (known, places) in object.known.windows(2).zip(intervals) {
            let line: Vec<(f64, f64)> = places.iter().map(|[x, y]| (1e3 * x, 1e3 * y)).collect();
            if let [Knowledge::Touched { .. }, Knowledge::Touched { .. }] = known {
                chart.draw_series([Element::line(line, MUTED.stroke_width(WIDTH))])?;
                continue;
            }
            if let [Some(from), Some(to)] = [room(known[0]), room(known[1])] {
                let mut area = line.clone();
                area.extend(limit(&line, 1e3 * from, 1e3 * to).into_iter().rev());
                chart.draw_series([Element::polygon(area, FAINT.filled().mix(0.5))])?;
            }
            chart.draw_series([Element::dashed(line, DASH, MUTED.stroke_width(WIDTH - 1))])?;
        }
    }
    Ok(())
}

/// How far the object may reach beyond a point, m; none where the rod was not.
fn room(known: Knowledge) -> Option<f64> {
    match known {
        Knowledge::Touched { .. } => Some(0.0),
        Knowledge::Bounded { room } => Some(room),
        Knowledge::Unknown => None,
    }
}

/// A line beside another one, at distances from one value to another on its right, where no solid is.
fn limit(line: &[(f64, f64)], from: f64, to: f64) -> Vec<(f64, f64)> {
    let last = line.len().saturating_sub(1);
    let place = |k: usize| {
        let ((x, y), (a, b)) = (line[k.saturating_sub(1)], line[(k + 1).min(last)]);
        let way = (a - x).hypot(b - y).max(f64::MIN_POSITIVE);
        let room = from + (to - from) * k as f64 / last.max(1) as f64;
        (line[k].0 + room * (b - y) / way, line[k].1 - room * (a - x) / way)
    };
    (0..line.len()).map(place).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_limit_is_where_no_solid_is() {
        // the solid is above a line to the right
        assert_eq!(limit(&[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0)], 1.0, 3.0), [(0.0, -1.0), (1.0, -2.0), (2.0, -3.0)]);
        assert!(limit(&[], 1.0, 1.0).is_empty());
    }
}
