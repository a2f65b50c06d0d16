//! The phases of the nine scans by object and distance (Merker et al. 2020, fig. 8a).

use crate::figure::canvas::{Area, BODY, FigureError, HPos, TITLE, stroke, svg, tick, width, write};
use crate::figure::element::Element;
use crate::figure::labels::Labels;
use crate::figure::palette::{FAINT, INK, MUTED, colour, ink_on};
use crate::paper::scans::{DISTANCES, OBJECTS, Paper, PaperScan};
use rod_files::CYCLES;
use vibrissa::contact::{EventKind, Phase};

/// Size of a cell, room left of and above the cells, room below for axis and key, pixels.
const CELL: (i32, i32) = (472, 190);
const LEFT: i32 = 90;
const HEAD: i32 = 130;
const FOOT: i32 = 200;
/// A strip within its cell: left and right margin, top, bottom.
const INSET: i32 = 24;
const STRIP: (i32, i32) = (112, 152);
/// What the axis shows, mm: a little more than the scans.
const ACROSS: (f64, f64) = (-95.0, 85.0);

/// Draws the chart of phase cycles.
pub(crate) fn cycles(paper: &Paper) -> Result<String, FigureError> {
    let (columns, rows) = (DISTANCES.len() as i32, OBJECTS.len() as i32);
    let size = (LEFT + columns * CELL.0 + 24, HEAD + rows * CELL.1 + FOOT);
    svg((size.0.unsigned_abs(), size.1.unsigned_abs()), |root| {
        write(root, "Phases along the nine scans, the clamp moving to −x", (24, 36), HPos::Left, TITLE, INK)?;
        for (column, distance) in (0..).zip(DISTANCES) {
            let x = LEFT + column * CELL.0;
            let text = format!("distance q = {distance} mm");
            write(root, &text, (x + CELL.0 / 2, HEAD - 28), HPos::Center, TITLE, INK)?;
            axis(root, x, HEAD + rows * CELL.1)?;
        }
        for (row, object) in (0..).zip(OBJECTS) {
            let y = HEAD + row * CELL.1;
            write(root, object, (LEFT / 2, y + CELL.1 / 2), HPos::Center, TITLE, INK)?;
            for (column, distance) in (0..).zip(DISTANCES) {
                let corner = (LEFT + column * CELL.0, y);
                root.draw(&Element::rectangle(
                    [corner, (corner.0 + CELL.0, corner.1 + CELL.1)],
                    FAINT.stroke_width(2),
                ))?;
                if let Some(scan) = paper.find(object, distance) {
                    cell(root, corner, scan)?;
                }
            }
        }
        key(root, HEAD + rows * CELL.1 + 130)
    })
}

/// Pixel column of a clamp position (mm) in the cell that starts at column `x`.
fn across(x: i32, place: f64) -> i32 {
    let part = (place - ACROSS.0) / (ACROSS.1 - ACROSS.0);
    x + INSET + (part.clamp(0.0, 1.0) * f64::from(CELL.0 - 2 * INSET)).round() as i32
}

/// The strip of phases of one scan and the name of its cycle.
fn cell(root: &Area<'_>, (x, y): (i32, i32), scan: &PaperScan) -> Result<(), FigureError> {
    let cycle = scan.scan.cycle();
    let name = cycle.name().unwrap_or("another");
    let verdict = if scan.matches() { "as in the paper" } else { "not as in the paper" };
    write(root, name, (x + INSET, y + 34), HPos::Left, TITLE + 4, INK)?;
    let cycle = format!("{cycle}, {verdict}");
    write(root, &cycle, (x + CELL.0 - INSET, y + 34), HPos::Right, BODY, MUTED)?;
    let (top, bottom) = (y + STRIP.0, y + STRIP.1);
    let mut labels = Labels::default();
    for interval in scan.scan.intervals() {
        let [start, end] = [interval.from, interval.to].map(|pose| across(x, 1e3 * pose.x));
        let (left, right) = (start.min(end), start.max(end));
        if interval.phase == Phase::FREE {
            stroke(root, vec![(left, (top + bottom) / 2), (right, (top + bottom) / 2)], MUTED.stroke_width(2))?;
            continue;
        }
        let colour = colour(interval.phase);
        root.draw(&Element::rectangle([(left, top), (right, bottom)], colour.filled()))?;
        stroke(root, vec![(left, top), (left, bottom)], INK.stroke_width(1))?;
        let name = interval.phase.to_string();
        let (middle, inside) = ((left + right) / 2, width(&name, BODY) + 4 <= right - left);
        let places =
            if inside { vec![(middle, (top + bottom) / 2)] } else { vec![(middle, top - 16), (middle, top - 42)] };
        if let Some(place) = labels.place(places, (width(&name, BODY) + 4, BODY as i32)) {
            write(root, &name, place, HPos::Center, BODY, if inside { ink_on(colour) } else { INK })?;
        }
        if matches!(interval.end, Some(EventKind::Snap | EventKind::SnapOff)) {
            snap(root, (end, bottom))?;
        }
    }
    Ok(())
}

/// A black triangle below the place of a snap.
fn snap(root: &Area<'_>, (x, y): (i32, i32)) -> Result<(), FigureError> {
    let triangle = Element::polygon(vec![(x, y + 6), (x - 11, y + 28), (x + 11, y + 28)], INK.filled());
    root.draw(&triangle)
}

fn axis(root: &Area<'_>, x: i32, y: i32) -> Result<(), FigureError> {
    for place in [-80, -40, 0, 40, 80] {
        let at = across(x, f64::from(place));
        stroke(root, vec![(at, y), (at, y + 10)], INK)?;
        write(root, &tick(&f64::from(place)), (at, y + 28), HPos::Center, BODY, INK)?;
    }
    write(root, "x_{0} in mm", (x + CELL.0 / 2, y + 66), HPos::Center, BODY, INK)
}

/// What the names and the triangle mean.
fn key(root: &Area<'_>, y: i32) -> Result<(), FigureError> {
    let cycles: Vec<String> = CYCLES.iter().map(|(name, phases)| format!("{name} = {phases}")).collect();
    write(root, &cycles.join(",   "), (24, y), HPos::Left, BODY, INK)?;
    snap(root, (36, y + 20))?;
    write(root, "snap or snap-off", (58, y + 38), HPos::Left, BODY, INK)
}
