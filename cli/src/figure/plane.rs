//! A part of the plane with axes in mm, a millimetre as long on both.

use super::canvas::{Area, FigureError};
use super::chart::{Chart, Room};
use std::ops::Range;

/// Room for the numbers and names of the axes, and around, pixels.
const LEFT: u32 = 96;
const BELOW: u32 = 62;
const MARGIN: u32 = 12;

/// What is seen.
pub(crate) struct PlaneWindow {
    /// mm
    pub x: Range<f64>,
    /// mm
    pub y: Range<f64>,
    /// mm per pixel
    pub scale: f64,
}

impl PlaneWindow {
    /// Width and height (pixels) that axes take beside their plot.
    pub const TRIMMINGS: (u32, u32) = (LEFT + 2 * MARGIN, BELOW + 2 * MARGIN);

    /// Shows these ranges (mm) in the middle of a plot of this width and height, with at least so much room beside and
    /// above (pixels).
    pub fn of(x: &Range<f64>, y: &Range<f64>, (width, height): (f64, f64), room: (f64, f64)) -> Self {
        let scale =
            |range: &Range<f64>, length: f64, room: f64| (range.end - range.start) / (length - 2.0 * room).max(1.0);
        let scale = scale(x, width, room.0).max(scale(y, height, room.1));
        Self { x: about(x, scale * width), y: about(y, scale * height), scale }
    }

    /// Shows these ranges (mm) as wide as a figure of `width` pixels allows, with a plot of a height within `heights` (pixels): the window, and the
    /// height of its area.
    pub fn as_wide_as(width: u32, x: &Range<f64>, y: &Range<f64>, heights: (f64, f64)) -> (Self, u32) {
        let (beside, below) = Self::TRIMMINGS;
        let plot = f64::from(width - beside);
        let high = (plot * (y.end - y.start) / (x.end - x.start)).clamp(heights.0, heights.1);
        (Self::of(x, y, (plot, high), (0.0, 0.0)), below + high.ceil() as u32)
    }

    /// Its axes, which fill `area`, with about so many numbers on x and y.
    pub fn chart<'a>(&self, area: &Area<'a>, numbers: (usize, usize)) -> Result<Chart<'a>, FigureError> {
        self.chart_called(area, numbers, ("x in mm", "y in mm"))
    }

    /// The same with other names for x and y.
    pub fn chart_called<'a>(
        &self,
        area: &Area<'a>,
        numbers: (usize, usize),
        names: (&str, &str),
    ) -> Result<Chart<'a>, FigureError> {
        let room = Room { left: LEFT + MARGIN, right: MARGIN, top: MARGIN, bottom: BELOW + MARGIN };
        let chart = Chart::new(area, room, self.x.clone(), self.y.clone());
        chart.axes(numbers, names)?;
        Ok(chart)
    }
}

/// A range of this length about the middle of another one.
fn about(range: &Range<f64>, length: f64) -> Range<f64> {
    let middle = 0.5 * (range.start + range.end);
    middle - 0.5 * length..middle + 0.5 * length
}
