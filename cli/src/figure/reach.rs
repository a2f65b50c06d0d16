//! What scans touch: the outlines, and a map by distance and angle.

use super::canvas::{Area, BODY, FigureError, HPos, PAGE, TITLE, span, stroke, svg, width, write};
use super::chart::{Chart, Room};
use super::contour;
use super::element::Element;
use super::line::thin_line;
use super::palette::{FAINT, INK, OTHERS, RGBColor};
use super::plane::PlaneWindow;
use rod_files::{Reached, Touch};

/// Heights of the title with its legend, of the plane (from, to), and of the map, pixels.
const HEAD: u32 = 116;
const PLANE: (f64, f64) = (360.0, 1100.0);
const MAP: u32 = 560;
/// Width of the line of an outline and of a curve, pixels.
const LINE: u32 = 10;
const CURVE: u32 = 5;
/// Height of the scale of colours above the map, pixels.
const SCALE: u32 = 60;
const ROOM: Room = Room { left: 108, right: 40, top: 20, bottom: 74 };

const KINDS: [(Touch, RGBColor, &str); 3] = [
    (Touch::Single, OTHERS[0], "one contact"),
    (Touch::Several, OTHERS[1], "several contacts only"),
    (Touch::Never, OTHERS[2], "never"),
];

/// Draws how each part of the outlines is touched, and below it the touched share by distance and angle.
pub(crate) fn reach(found: &Reached) -> Result<String, FigureError> {
    let points: Vec<Vec<(f64, f64)>> =
        found.objects.iter().enumerate().map(|(object, _)| line(found, object, None)).collect();
    let x = span(points.iter().flatten().map(|point| point.0), 0.08);
    let y = span(points.iter().flatten().map(|point| point.1), 0.08);
    let (window, plane) = PlaneWindow::as_wide_as(PAGE, &x, &y, PLANE);
    svg((PAGE, HEAD + plane + MAP), |root| {
        let (head, body) = root.split_vertically(HEAD);
        let (above, below) = body.split_vertically(plane);
        write(&head, &format!("{}: what straight scans touch", found.name), (24, 36), HPos::Left, TITLE, INK)?;
        let mut left = 24;
        for (touch, colour, name) in KINDS {
            let name = format!("{name} {:.1} %", 100.0 * found.share(touch));
            stroke(&head, vec![(left, 84), (left + 44, 84)], colour.stroke_width(LINE))?;
            write(&head, &name, (left + 56, 84), HPos::Left, BODY, INK)?;
            left += 56 + width(&name, BODY) + 30;
        }
        let chart = window.chart(&above, (12, 10))?;
        for (object, points) in points.iter().enumerate() {
            contour::draw(&chart, &window, points.iter().copied())?;
            for (touch, colour, _) in KINDS {
                for part in found.parts(object, touch).parts() {
                    let part = thin_line(line(found, object, Some(*part)), (window.scale, window.scale));
                    chart.draw_series([Element::line(part, colour.stroke_width(LINE))])?;
                }
            }
        }
        if found.grid.angles.len() > 1 { map(&below, found) } else { curves(&below, found) }
    })
}

/// Points (mm) along an outline, or a part of it.
fn line(found: &Reached, object: usize, part: Option<(f64, f64)>) -> Vec<(f64, f64)> {
    let (shape, outline) = (&found.objects[object], &found.found.outlines[object]);
    let (from, to) = part.unwrap_or((0.0, outline.length()));
    let ends = [from, to].map(|place| outline.frame(shape, place));
    let within = outline.points(shape).filter(|(place, _)| from < *place && *place < to).map(|(_, frame)| frame);
    let frames = [ends[0]].into_iter().chain(within).chain([ends[1]]);
    frames.map(|frame| (1e3 * frame.x, 1e3 * frame.y)).collect()
}

/// Touched shares by the distance, of the passes to both sides together.
fn curves(area: &Area<'_>, found: &Reached) -> Result<(), FigureError> {
    let distances: Vec<f64> = found.grid.distances.iter().map(|distance| 1e3 * distance).collect();
    let chart = Chart::new(area, ROOM, span(distances.iter().copied(), 0.02), 0.0..100.0);
    chart.axes((12, 6), ("distance in mm", "touched in %"))?;
    let shares: Vec<[f64; 2]> = (0..distances.len()).map(|cell| found.shares_of_cell(cell)).collect();
    for (which, colour, dash) in [(1, OTHERS[1], (1, 0)), (0, OTHERS[0], (14, 8))] {
        let points = distances.iter().zip(&shares).map(|(distance, shares)| (*distance, 100.0 * shares[which]));
        chart.draw_series([Element::dashed(points, dash, colour.stroke_width(CURVE))])?;
    }
    write(area, "at all", (220, 34), HPos::Left, BODY, OTHERS[1])?;
    write(area, "with one contact (dashed)", (320, 34), HPos::Left, BODY, OTHERS[0])
}

/// Touched share by distance and angle, of the passes to both sides together.
fn map(area: &Area<'_>, found: &Reached) -> Result<(), FigureError> {
    let (scale, area) = area.split_vertically(SCALE);
    let distances: Vec<f64> = found.grid.distances.iter().map(|distance| 1e3 * distance).collect();
    let angles: Vec<f64> = found.grid.angles.iter().map(|angle| angle.to_degrees()).collect();
    let (columns, rows) = (cells(&angles), cells(&distances));
    let range = |cells: &[(f64, f64)]| span(cells.iter().flat_map(|cell| [cell.0, cell.1]), 0.0);
    let chart = Chart::new(&area, ROOM, range(&columns), range(&rows));
    let shares: Vec<f64> = (0..angles.len() * distances.len()).map(|cell| found.shares_of_cell(cell)[1]).collect();
    let most = shares.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    for (cell, share) in shares.iter().enumerate() {
        let (column, row) = (columns[cell / distances.len()], rows[cell % distances.len()]);
        let corners = [(column.0, row.0), (column.1, row.1)];
        chart.draw_series([Element::rectangle(corners, shade(share / most).filled())])?;
    }
    chart.axes((12, 8), ("angle in deg", "distance in mm"))?;
    write(&scale, "touched share in %", (ROOM.left as i32, 34), HPos::Left, BODY, INK)?;
    for step in 0..=4 {
        let left = ROOM.left as i32 + 300 + 180 * step;
        let share = f64::from(step) / 4.0;
        scale.draw(&Element::rectangle([(left, 18), (left + 50, 50)], shade(share).filled()))?;
        write(&scale, &format!("{:.0}", 100.0 * share * most), (left + 62, 34), HPos::Left, BODY, INK)?;
    }
    Ok(())
}

/// Intervals about values: to the middle between neighbours. A single value has a wide one.
fn cells(values: &[f64]) -> Vec<(f64, f64)> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.dedup();
    let middle = |k: usize| 0.5 * (sorted[k] + sorted[k + 1]);
    let cell = |value: &f64| {
        let k = sorted.partition_point(|other| other < value);
        let before = (k > 0).then(|| middle(k - 1));
        let after = (k + 1 < sorted.len()).then(|| middle(k));
        match (before, after) {
            (Some(before), Some(after)) => (before, after),
            (Some(before), None) => (before, 2.0 * value - before),
            (None, Some(after)) => (2.0 * value - after, after),
            (None, None) => (value - 1.0, value + 1.0),
        }
    };
    values.iter().map(cell).collect()
}

/// From grey at 0 to full colour at 1.
fn shade(share: f64) -> RGBColor {
    let RGBColor(r, g, b) = OTHERS[0];
    let RGBColor(fr, fg, fb) = FAINT;
    let mixed = |from: u8, to: u8| (f64::from(from) + share * (f64::from(to) - f64::from(from))).round() as u8;
    RGBColor(mixed(fr, r), mixed(fg, g), mixed(fb, b))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_meet_in_the_middle() {
        assert_eq!(cells(&[3.0, 1.0, 2.0]), [(2.5, 3.5), (0.5, 1.5), (1.5, 2.5)]);
        assert_eq!(cells(&[4.0]), [(3.0, 5.0)]);
    }
}
