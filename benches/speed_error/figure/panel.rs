//! Points of one task: error to the right, time upwards, both logarithmic.

use super::axis::Decades;
use super::canvas::{Area, BODY, FAINT, INK, Look, SMALL, stroke, width, write, write_upwards};
use crate::row::{NONE, Row};
use plotters::style::text_anchor::HPos;

/// Size of a panel and what is around its plot: left, above, right, below (pixels).
pub const SIZE: (u32, u32) = (860, 680);
const AROUND: [i32; 4] = [120, 50, 30, 90];
/// Where an error of 0 is drawn, which has no logarithm.
pub const ZERO: f64 = 1e-17;
/// From a point to the middle of its setting, and room around a setting.
const BESIDE: i32 = 12;
const ROOM: i32 = 2;

/// What is drawn of a row, if there is an answer.
pub fn coordinates(row: &Row) -> Option<(f64, f64)> {
    Some((row.error?.max(ZERO), row.seconds?))
}

/// The lines of a panel: the look of each method and its rows, in the order of their settings.
pub type Lines<'a> = Vec<(Look, Vec<&'a Row>)>;

/// A rectangle of pixels: left, top, right, bottom.
#[derive(Clone, Copy)]
struct Rect(i32, i32, i32, i32);

impl Rect {
    fn meets(&self, other: &Self) -> bool {
        self.0 < other.2 && other.0 < self.2 && self.1 < other.3 && other.1 < self.3
    }
}

/// Draws a panel; the axes hold all of `rows`, those of the other panels too.
pub fn draw(area: &Area<'_>, title: &str, unit: &str, lines: &Lines<'_>, rows: &[&Row]) {
    let [left, above, right, below] = AROUND;
    let (right, bottom) = (SIZE.0 as i32 - right, SIZE.1 as i32 - below);
    let all = || rows.iter().filter_map(|row| coordinates(row));
    let x = Decades::of(all().map(|(error, _)| error), (left, right));
    let y = Decades::of(all().map(|(_, seconds)| seconds), (bottom, above));
    write(area, title, (left, above / 2), HPos::Left, BODY, INK);
    for (at, name) in x.ticks() {
        stroke(area, vec![(at, above), (at, bottom)], FAINT);
        name.iter().for_each(|name| write(area, name, (at, bottom + 22), HPos::Center, BODY, INK));
    }
    for (at, name) in y.ticks() {
        stroke(area, vec![(left, at), (right, at)], FAINT);
        name.iter().for_each(|name| write(area, name, (left - 10, at), HPos::Right, BODY, INK));
    }
    stroke(area, vec![(left, above), (left, bottom), (right, bottom)], INK);
    write(area, "error, relative to 1 + |true value|", ((left + right) / 2, bottom + 62), HPos::Center, BODY, INK);
    write_upwards(area, unit, (26, (above + bottom) / 2), BODY);

    let place = |row: &Row| coordinates(row).map(|(error, seconds)| (x.pixel(error), y.pixel(seconds)));
    let mut crossed = Vec::new();
    for (look, rows) in lines {
        let line: Vec<_> = rows.iter().filter_map(|row| place(row)).collect();
        crossed.extend(line.windows(2).flat_map(|pair| along(pair[0], pair[1])));
        look.line(area, line);
    }
    let points = || lines.iter().flat_map(|(look, rows)| rows.iter().map(move |row| (*look, *row)));
    let mut taken = Vec::new();
    for (look, row) in points() {
        if let Some((x, y)) = place(row) {
            look.mark(area, (x, y));
            taken.push(Rect(x - 8, y - 8, x + 8, y + 8));
        }
    }
    // the ends of a line first, for they tell the rest
    let is_end = |rows: &[&Row], row: &Row| rows.first() == Some(&row) || rows.last() == Some(&row);
    for ends in [true, false] {
        for (look, rows) in lines {
            for row in rows.iter().filter(|row| row.setting != NONE && is_end(rows, row) == ends) {
                let Some((x, y)) = place(row) else { continue };
                let (w, h) = (width(&row.setting, SMALL), SMALL as i32);
                let corners = [
                    (x + BESIDE, y - h / 2),
                    (x - BESIDE - w, y - h / 2),
                    (x - w / 2, y - BESIDE - h),
                    (x - w / 2, y + BESIDE),
                ];
                let spot = |(x, y): (i32, i32)| Rect(x - ROOM, y - ROOM, x + w + ROOM, y + h + ROOM);
                let inside = |spot: &Rect| spot.0 > left && spot.2 < right + 25 && spot.1 > above && spot.3 < bottom;
                let free = |spot: &Rect, others: &[Rect]| !others.iter().any(|other| other.meets(spot));
                let spots = || corners.map(spot).into_iter().filter(|spot| inside(spot) && free(spot, &taken));
                // rather beside all lines; the end of a line has to be read in any case
                let beside = spots().find(|spot| free(spot, &crossed));
                if let Some(spot) = beside.or_else(|| spots().next().filter(|_| ends)) {
                    let at = (spot.0 + ROOM, (spot.1 + spot.3) / 2);
                    write(area, &row.setting, at, HPos::Left, SMALL, look.colour());
                    taken.push(spot);
                }
            }
        }
    }
}

/// What a straight line covers, in small pieces.
fn along(from: (i32, i32), to: (i32, i32)) -> impl Iterator<Item = Rect> {
    let pieces = ((to.0 - from.0).abs().max((to.1 - from.1).abs()) / 4).max(1);
    (0..=pieces).map(move |k| {
        let at = |from: i32, to: i32| from + (to - from) * k / pieces;
        let (x, y) = (at(from.0, to.0), at(from.1, to.1));
        Rect(x - 1, y - 1, x + 1, y + 1)
    })
}
