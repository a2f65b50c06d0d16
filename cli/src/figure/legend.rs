//! What the lines of a sweep mean.

use super::canvas::{Area, BODY, FigureError, HPos, stroke, width, write};
use super::contour;
use super::element::ShapeStyle;
use super::palette::{INK, TRANSITION, colour, mode_colour};
use super::trace::MODE;
use rod_files::Interval;
use vibrissa::contact::{EventKind, Phase, SlipMode};

/// Height of a row, pixels.
const ROW: u32 = 34;
/// Length of a sample, with the gap behind it, and the gap behind its name, pixels.
const SAMPLE: i32 = 44;
const GAP: i32 = 10;
const APART: i32 = 24;

/// Samples of lines with their names, in rows.
pub(super) struct Legend {
    entries: Vec<Entry>,
    /// How many there are.
    rows: u32,
}

struct Entry {
    name: String,
    style: ShapeStyle,
    dashed: bool,
    /// Where it starts, pixels, and in which row.
    place: (i32, u32),
}

impl Entry {
    fn width(&self) -> i32 {
        SAMPLE + GAP + width(&self.name, BODY)
    }

    /// Draws the sample and its name from x on, at the height y.
    fn draw(&self, area: &Area<'_>, (x, y): (i32, i32)) -> Result<(), FigureError> {
        let parts = if self.dashed { vec![(0, 14), (24, 38)] } else { vec![(0, SAMPLE)] };
        for (from, to) in parts {
            stroke(area, vec![(x + from, y), (x + to, y)], self.style)?;
        }
        write(area, &self.name, (x + SAMPLE + GAP, y), HPos::Left, BODY, INK)
    }
}

impl Legend {
    /// The legend of a sweep with these parts and modes of friction, in rows of at most this width (pixels). Phases of one colour share a
    /// sample.
    pub fn of(intervals: &[Interval<'_>], modes: &[SlipMode], room: i32) -> Self {
        let entry = |name: String, style: ShapeStyle| Entry { name, style, dashed: false, place: (0, 0) };
        let mut entries = vec![entry("contour".into(), INK.stroke_width(contour::WIDTH))];
        let mut phases: Vec<Phase> = Vec::new();
        for interval in intervals {
            if !phases.contains(&interval.phase) {
                phases.push(interval.phase);
            }
        }
        while let Some(first) = phases.first().copied() {
            let alike = phases.extract_if(.., |phase| colour(*phase) == colour(first));
            let alike: Vec<String> = alike.map(|phase| phase.to_string()).collect();
            let name = match alike.len() {
                _ if first == Phase::FREE => "free".to_owned(),
                1 => format!("phase {first}"),
                _ => format!("phases {}", alike.join(", ")),
            };
            entries.push(entry(name, colour(first).stroke_width(5)));
        }
        if intervals.len() > 1 {
            entries.push(entry("at a transition".into(), TRANSITION.stroke_width(3)));
        }
        if intervals.iter().any(|interval| interval.end == Some(EventKind::Snap)) {
            entries.push(Entry { dashed: true, ..entry("after a snap".into(), TRANSITION.stroke_width(3)) });
        }
        entries.extend(modes.iter().map(|mode| entry(mode.to_string(), mode_colour(*mode).stroke_width(MODE))));
        let (mut x, mut row) = (0, 0);
        for entry in &mut entries {
            if x > 0 && x + entry.width() > room {
                (x, row) = (0, row + 1);
            }
            entry.place = (x, row);
            x += entry.width() + APART;
        }
        Self { entries, rows: row + 1 }
    }

    /// Its height, pixels.
    pub fn height(&self) -> u32 {
        ROW * self.rows
    }

    /// Draws it from a corner on.
    pub fn draw(&self, area: &Area<'_>, (left, top): (i32, u32)) -> Result<(), FigureError> {
        self.entries.iter().try_for_each(|entry| {
            let (x, row) = entry.place;
            entry.draw(area, (left + x, (top + ROW * row + ROW / 2) as i32))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample::{along, event, outcome};
    use rod_files::intervals;

    #[test]
    fn rows_are_no_wider_than_their_room_and_phases_of_one_colour_share_a_sample() {
        let names = ["A", "B", "BA", "BB", "BBA", "BBB", "BBBA", "BBBB"];
        let events = names.windows(2).map(|pair| event(1.0, pair[0], pair[1], EventKind::Snap)).collect();
        let outcome = outcome(&[(0.0, "A")], events);
        let legend = Legend::of(&intervals(along, &outcome), &[], 1200);
        let names: Vec<&str> = legend.entries.iter().map(|entry| entry.name.as_str()).collect();
        let phases = ["phase A", "phase B", "phase BA", "phase BB", "phases BBA, BBBA", "phases BBB, BBBB"];
        assert_eq!(names[1..7], phases);
        assert_eq!(names[7..], ["at a transition", "after a snap"]);
        assert!(legend.entries.iter().all(|entry| entry.place.0 + entry.width() <= 1200));
        assert_eq!((legend.rows, legend.entries.last().map(|entry| entry.place.1)), (2, Some(1)));
    }
}
