//! One quantity along a scan, with its phases.

use super::abscissa::Course;
use super::canvas::{Area, BODY, FigureError, HPos, span, width, write};
use super::chart::{Chart, Room};
use super::element::{Element, ShapeStyle};
use super::labels::Labels;
use super::palette::{FAINT, INK, TRANSITION, colour, mode_colour};
use rod_files::Interval;
use rod_files::Scan;
use std::ops::Range;
use vibrissa::State;
use vibrissa::contact::SlipMode;

/// Room on the left for the numbers and the name of the axis, and below for those of the abscissa, pixels.
const LEFT: u32 = 130;
const BELOW: u32 = 70;
/// Room above for two rows of phases, pixels.
pub(crate) const ABOVE: u32 = 70;

/// Widths of a line, of the pale one behind it where a contact sticks, and of that which tells a mode, pixels.
pub(crate) const LINE: u32 = 4;
const PALE: u32 = 14;
pub(crate) const MODE: u32 = 9;
/// Height of the row of a contact, in parts of the height of the plot.
const STRIP: f64 = 0.06;

/// Least gap between two names of phases in a row, pixels: two names closer read as one.
const APART: i32 = 14;

/// What the traces of one scan above each other share.
pub(crate) struct Along {
    /// Range of the abscissa.
    pub across: Range<f64>,
    /// What the abscissa is.
    pub foot: String,
    /// Parts of the abscissa with the names of their phases.
    pub phases: Vec<(Range<f64>, String)>,
    /// Where something happens.
    pub marks: Vec<f64>,
    /// Where one leg of the path ends and the next one begins.
    pub legs: Vec<f64>,
    /// Parts of the abscissa along which a contact has one mode of friction: which, counted from the clamp, and the mode.
    pub modes: Vec<(Range<f64>, usize, SlipMode)>,
}

/// A part of a trace: points in the units of the axes.
pub(crate) struct TracePart {
    pub points: Vec<(f64, f64)>,
    pub style: ShapeStyle,
}

/// What to draw.
pub(crate) struct TraceChart<'a> {
    pub along: &'a Along,
    pub parts: Vec<TracePart>,
    /// The quantity and its unit.
    pub name: &'a str,
    /// Whether the phases stand above.
    pub phases: bool,
    /// Whether the abscissa stands below.
    pub foot: bool,
}

/// Height (pixels) that a trace takes beside its plot.
pub(crate) fn trimmings(phases: bool, foot: bool) -> u32 {
    u32::from(phases) * ABOVE + u32::from(foot) * BELOW
}

impl Along {
    /// A sweep, with its transitions as marks.
    pub fn of(scan: &Scan) -> Self {
        let course = Course::of(&scan.scene);
        let intervals = scan.intervals();
        let ends = |part: &Interval<'_>| {
            let at = |state: Option<&&State>| state.map_or(0.0, |state| course.value(state));
            at(part.states.first())..at(part.states.last())
        };
        let ended = intervals.iter().filter(|part| part.end.is_some());
        Self {
            across: span(course.ends(), 0.02),
            foot: course.label(),
            phases: intervals.iter().map(|part| (ends(part), part.phase.to_string())).collect(),
            marks: ended.map(|part| ends(part).end).collect(),
            legs: if let [_, between @ .., _] = &course.ends()[..] { between.to_vec() } else { Vec::new() },
            modes: scan
                .between_events()
                .iter()
                .flat_map(|part| modes(part).map(|(k, mode)| (ends(part), k, mode)))
                .collect(),
        }
    }

    /// The modes of friction that there are.
    pub fn all_modes(&self) -> Vec<SlipMode> {
        let all = [SlipMode::Forward, SlipMode::Backward, SlipMode::Stick];
        all.into_iter().filter(|mode| self.modes.iter().any(|(.., there)| there == mode)).collect()
    }
}

/// The mode of friction of each contact along a part without events.
fn modes<'a>(part: &Interval<'a>) -> impl Iterator<Item = (usize, SlipMode)> + 'a {
    // others may be reported at the very pose of the event before
    let contacts = part.states.first().copied().into_iter().flat_map(|state| state.contacts.iter().enumerate());
    contacts.filter_map(|(number, contact)| Some((number, contact.friction?.mode)))
}

/// A quantity along a sweep, coloured by phase; a wide, pale line where a contact sticks or rolls.
pub(crate) fn parts(scan: &Scan, quantity: impl Fn(&State) -> f64) -> Vec<TracePart> {
    let course = Course::of(&scan.scene);
    let point = |state: &&State| (course.value(state), quantity(state));
    let intervals = scan.intervals();
    let drawn = |part: &Interval<'_>, style| TracePart { points: part.states.iter().map(point).collect(), style };
    let pieces = scan.between_events();
    let sticks = pieces.iter().filter(|part| modes(part).any(|(_, mode)| mode == SlipMode::Stick));
    let sticks = sticks.map(|part| drawn(part, mode_colour(SlipMode::Stick).stroke_width(PALE)));
    sticks.chain(intervals.iter().map(|part| drawn(part, colour(part.phase).stroke_width(LINE)))).collect()
}

/// Draws quantities, each with its unit, into an area of `root`, above each other in plots of this height (pixels): the phases above the first one, the
/// abscissa below the last.
pub(crate) fn stack(
    root: &Area<'_>,
    area: &Area<'_>,
    along: &Along,
    plot: u32,
    traces: Vec<(&str, Vec<TracePart>)>,
) -> Result<(), FigureError> {
    let (last, mut rest) = (traces.len().saturating_sub(1), area.clone());
    for (index, (name, parts)) in traces.into_iter().enumerate() {
        let (phases, foot) = (index == 0, index == last);
        let (part, below) = rest.split_vertically(plot + trimmings(phases, foot));
        draw(root, &part, &TraceChart { along, parts, name, phases, foot })?;
        rest = below;
    }
    Ok(())
}

/// Draws a trace into a part of `root`.
pub(crate) fn draw(root: &Area<'_>, area: &Area<'_>, trace: &TraceChart<'_>) -> Result<(), FigureError> {
    let Along { across, foot, phases, marks, legs, modes } = trace.along;
    let values = trace.parts.iter().flat_map(|part| part.points.iter().map(|point| point.1));
    let mut up = span(values.chain([0.0]), 0.08);
    let row = STRIP * (up.end - up.start);
    let rows = modes.iter().map(|mode| mode.1 + 1).max().filter(|_| trace.phases).unwrap_or(0);
    up.end += row * rows as f64;
    let room = Room {
        left: LEFT,
        right: 30,
        top: if trace.phases { ABOVE } else { 8 },
        bottom: 8 + if trace.foot { BELOW } else { 0 },
    };
    let chart = Chart::new(area, room, across.clone(), up.clone());
    chart.axes((12, 5), (if trace.foot { foot } else { "" }, trace.name))?;
    chart.draw_series([Element::line(vec![(across.start, 0.0), (across.end, 0.0)], FAINT)])?;
    for &place in legs {
        chart.draw_series([Element::line(vec![(place, up.start), (place, up.end)], FAINT.stroke_width(2))])?;
    }
    for part in &trace.parts {
        chart.draw_series([Element::line(part.points.iter().copied(), part.style)])?;
    }
    for &place in marks {
        chart.draw_series([Element::line(vec![(place, up.start), (place, up.end)], TRANSITION.stroke_width(1))])?;
    }
    for (part, contact, mode) in modes.iter().filter(|_| trace.phases) {
        let y = up.end - row * (*contact as f64 + 0.5);
        chart.draw_series([Element::line(
            vec![(part.start, y), (part.end, y)],
            mode_colour(*mode).stroke_width(MODE),
        )])?;
    }
    if trace.phases { name_phases(root, &chart, phases, up.end) } else { Ok(()) }
}

/// Writes the phases above the chart, over their parts; where those are short, in a second row.
fn name_phases(
    root: &Area<'_>,
    chart: &Chart<'_>,
    phases: &[(Range<f64>, String)],
    top: f64,
) -> Result<(), FigureError> {
    let mut labels = Labels::default();
    for (part, name) in phases {
        let (x, y) = chart.backend_coord(&(0.5 * (part.start + part.end), top));
        let size = (width(name, BODY) + APART, BODY as i32 + 2);
        if let Some(place) = labels.place([(x, y - 18), (x, y - 46)], size) {
            write(root, name, place, HPos::Center, BODY, INK)?;
        }
    }
    Ok(())
}
