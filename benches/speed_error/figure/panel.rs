//! Points of one task: error to the right, time upwards, both logarithmic.

use super::axis::Decades;
use super::canvas::{BODY, FAINT, INK, Point, SMALL, Sheet, Side, width};
use super::look::Look;
use crate::row::{NONE, Row};

/// Size of a panel and what is around its plot: left, above, right, below (pixels).
pub const SIZE: Point = (765.0, 640.0);
const AROUND: [f64; 4] = [112.0, 50.0, 30.0, 90.0];
/// Where an error of 0 is drawn, which has no logarithm.
pub const ZERO: f64 = 1e-17;
/// From a point to the middle of its setting, and room around a setting.
const BESIDE: f64 = 12.0;
const ROOM: f64 = 2.0;
/// Half the width of what a mark covers.
const COVERED: f64 = 8.0;

/// What is drawn of a row, if there is an answer.
pub fn coordinates(row: &Row) -> Option<(f64, f64)> {
    Some((row.error?.max(ZERO), row.seconds?))
}

/// The lines of a panel: the look of each method and its rows, in the order of their settings.
pub type Lines<'a> = Vec<(Look, Vec<&'a Row>)>;

/// A rectangle of pixels: left, top, right, bottom.
#[derive(Clone, Copy)]
struct Rect(f64, f64, f64, f64);

impl Rect {
    fn meets(&self, other: &Self) -> bool {
        self.0 < other.2 && other.0 < self.2 && self.1 < other.3 && other.1 < self.3
    }
}

/// Draws a panel; the axes hold all of `rows`, those of the other panels too.
pub fn draw(sheet: &mut Sheet, title: &str, unit: &str, lines: &Lines<'_>, rows: &[&Row]) {
    let [left, above, right, below] = AROUND;
    let (right, bottom) = (SIZE.0 - right, SIZE.1 - below);
    let all = || rows.iter().filter_map(|row| coordinates(row));
    let x = Decades::of(all().map(|(error, _)| error), (left, right));
    let y = Decades::of(all().map(|(_, seconds)| seconds), (bottom, above));
    sheet.write(title, (left, 0.5 * above), Side::Left, BODY, INK);
    for (at, name) in x.ticks() {
        sheet.line(&[(at, above), (at, bottom)], FAINT, 1.0);
        name.iter().for_each(|name| sheet.write(name, (at, bottom + 22.0), Side::Middle, BODY, INK));
    }
    for (at, name) in y.ticks() {
        sheet.line(&[(left, at), (right, at)], FAINT, 1.0);
        name.iter().for_each(|name| sheet.write(name, (left - 10.0, at), Side::Right, BODY, INK));
    }
    sheet.line(&[(left, above), (left, bottom), (right, bottom)], INK, 1.0);
    let middle = 0.5 * (left + right);
    sheet.write("error, relative to 1 + |true value|", (middle, bottom + 62.0), Side::Middle, BODY, INK);
    sheet.write_upwards(unit, (20.0, 0.5 * (above + bottom)), BODY);

    let place = |row: &Row| coordinates(row).map(|(error, seconds)| (x.pixel(error), y.pixel(seconds)));
    let mut crossed = Vec::new();
    for (look, rows) in lines {
        let line: Vec<_> = rows.iter().filter_map(|row| place(row)).collect();
        crossed.extend(line.windows(2).flat_map(|pair| along(pair[0], pair[1])));
        look.line(sheet, &line);
    }
    let points = || lines.iter().flat_map(|(look, rows)| rows.iter().map(move |row| (*look, *row)));
    let mut taken = Vec::new();
    for (look, row) in points() {
        if let Some((x, y)) = place(row) {
            look.mark(sheet, (x, y));
            taken.push(Rect(x - COVERED, y - COVERED, x + COVERED, y + COVERED));
        }
    }
    // the ends of a line first, for they tell the rest
    let is_end = |rows: &[&Row], row: &Row| rows.first() == Some(&row) || rows.last() == Some(&row);
    for ends in [true, false] {
        for (look, rows) in lines {
            for row in rows.iter().filter(|row| row.setting != NONE && is_end(rows, row) == ends) {
                let Some((x, y)) = place(row) else { continue };
                let (w, h) = (width(&row.setting, SMALL), SMALL);
                let corners = [
                    (x + BESIDE, y - 0.5 * h),
                    (x - BESIDE - w, y - 0.5 * h),
                    (x - 0.5 * w, y - BESIDE - h),
                    (x - 0.5 * w, y + BESIDE),
                ];
                let spot = |(x, y): Point| Rect(x - ROOM, y - ROOM, x + w + ROOM, y + h + ROOM);
                let inside = |spot: &Rect| spot.0 > left && spot.2 < right + 25.0 && spot.1 > above && spot.3 < bottom;
                let free = |spot: &Rect, others: &[Rect]| !others.iter().any(|other| other.meets(spot));
                let spots = || corners.map(spot).into_iter().filter(|spot| inside(spot) && free(spot, &taken));
                // rather beside all lines; the end of a line has to be read in any case
                let beside = spots().find(|spot| free(spot, &crossed));
                if let Some(spot) = beside.or_else(|| spots().next().filter(|_| ends)) {
                    let at = (spot.0 + ROOM, 0.5 * (spot.1 + spot.3));
                    sheet.write(&row.setting, at, Side::Left, SMALL, look.colour());
                    taken.push(spot);
                }
            }
        }
    }
}

/// What a straight line covers, in small pieces.
fn along(from: Point, to: Point) -> impl Iterator<Item = Rect> {
    let pieces = ((to.0 - from.0).abs().max((to.1 - from.1).abs()) / 4.0).ceil().max(1.0) as u32;
    (0..=pieces).map(move |k| {
        let at = |from: f64, to: f64| from + (to - from) * f64::from(k) / f64::from(pieces);
        let (x, y) = (at(from.0, to.0), at(from.1, to.1));
        Rect(x - 1.0, y - 1.0, x + 1.0, y + 1.0)
    })
}
