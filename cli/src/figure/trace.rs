//! One quantity along a scan, with its phases.

use super::abscissa::Abscissa;
use super::canvas::{Area, BODY, Chart, FigureError, axes, span, width, write};
use super::labels::Labels;
use super::palette::{FAINT, INK, colour};
use crate::{Interval, Scan};
use plotters::prelude::*;
use plotters::style::text_anchor::HPos;
use std::ops::Range;
use vibrissa::State;

/// Room on the left for the numbers and the name of the axis, and below for those of the abscissa, pixels.
const LEFT: u32 = 130;
const BELOW: u32 = 80;
/// Room above for two rows of phases, pixels.
pub(super) const ABOVE: u32 = 70;

/// A number that a state has.
pub(super) type Quantity<'a> = &'a dyn Fn(&State) -> f64;

/// What to draw.
pub(super) struct Trace<'a> {
    pub scan: &'a Scan,
    /// The quantity, in the unit that its name says.
    pub quantity: Quantity<'a>,
    pub name: &'a str,
    /// Range of the abscissa, shared by traces above each other.
    pub across: Range<f64>,
    /// Whether the phases stand above.
    pub phases: bool,
    /// Whether the abscissa stands below.
    pub foot: bool,
}

/// Height (pixels) that a trace takes beside its plot.
pub(super) fn trimmings(phases: bool, foot: bool) -> u32 {
    u32::from(phases) * ABOVE + u32::from(foot) * BELOW
}

/// The range of the abscissa that shows a scan.
pub(super) fn across(scan: &Scan) -> Range<f64> {
    let (path, abscissa) = (&scan.scene.path, Abscissa::of(&scan.scene.path));
    span([0.0, path.length()].map(|way| abscissa.value(path.at(way))), 0.02)
}

/// Draws a trace into a part of `root`.
pub(super) fn draw(root: &Area<'_>, area: &Area<'_>, trace: &Trace<'_>) -> Result<(), FigureError> {
    let intervals = trace.scan.intervals();
    let abscissa = Abscissa::of(&trace.scan.scene.path);
    let values = intervals.iter().flat_map(|interval| interval.states.iter().map(|state| (trace.quantity)(state)));
    let up = span(values.chain([0.0]), 0.08);
    let mut chart = ChartBuilder::on(area)
        .margin_top(if trace.phases { ABOVE } else { 8 })
        .margin_bottom(8)
        .margin_left(10)
        .margin_right(30)
        .set_label_area_size(LabelAreaPosition::Left, LEFT)
        .set_label_area_size(LabelAreaPosition::Bottom, if trace.foot { BELOW } else { 0 })
        .build_cartesian_2d(trace.across.clone(), up.clone())?;
    let foot = if trace.foot { abscissa.label(&trace.scan.scene.path) } else { String::new() };
    axes(&mut chart, (12, 5), (&foot, trace.name))?;
    chart.draw_series([PathElement::new(vec![(trace.across.start, 0.0), (trace.across.end, 0.0)], FAINT)])?;
    for interval in &intervals {
        let points = interval.states.iter().map(|state| (abscissa.value(state.pose), (trace.quantity)(state)));
        chart.draw_series(LineSeries::new(points, colour(interval.phase).stroke_width(4)))?;
        if interval.end.is_some() {
            let place = abscissa.value(interval.to);
            chart.draw_series([PathElement::new(vec![(place, up.start), (place, up.end)], INK.stroke_width(1))])?;
        }
    }
    if trace.phases { name_phases(root, &chart, &intervals, abscissa, up.end) } else { Ok(()) }
}

/// Writes the phases above the chart, over their intervals; where those are short, in a second row.
fn name_phases(
    root: &Area<'_>,
    chart: &Chart<'_, '_>,
    intervals: &[Interval<'_>],
    abscissa: Abscissa,
    top: f64,
) -> Result<(), FigureError> {
    let mut labels = Labels::default();
    for interval in intervals {
        let (x, y) = chart.backend_coord(&(0.5 * (abscissa.value(interval.from) + abscissa.value(interval.to)), top));
        let name = interval.phase.to_string();
        let size = (width(&name, BODY) + 6, BODY as i32 + 2);
        if let Some(place) = labels.place([(x, y - 18), (x, y - 46)], size) {
            write(root, &name, place, HPos::Center, BODY, INK)?;
        }
    }
    Ok(())
}
