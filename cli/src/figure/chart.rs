//! A plot with axes.

use super::canvas::{Area, BODY, FigureError, stroke, width};
use super::element::{Element, number};
use super::palette::INK;
use super::scale::AxisScale;
use super::text::{HPos, Letters};
use std::ops::Range;

/// Length of a tick, and from the axis to the middle of its number, pixels.
const TICK: i32 = 7;
const NUMBER: i32 = 24;

/// Room around a plot, pixels.
#[derive(Clone, Copy)]
pub(crate) struct Room {
    pub left: u32,
    pub right: u32,
    pub top: u32,
    pub bottom: u32,
}

/// A rectangle with axes.
pub(crate) struct Chart<'a> {
    area: Area<'a>,
    plot: Area<'a>,
    x: Range<f64>,
    y: Range<f64>,
}

impl<'a> Chart<'a> {
    /// A plot of these ranges in an area, with room around for numbers and names.
    pub fn new(area: &Area<'a>, room: Room, x: Range<f64>, y: Range<f64>) -> Self {
        let (width, height) = area.dim_in_pixel();
        let (_, below) = area.split_vertically(room.top);
        let (middle, _) = below.split_vertically(height.saturating_sub(room.top + room.bottom));
        let (_, right) = middle.split_horizontally(room.left);
        let (plot, _) = right.split_horizontally(width.saturating_sub(room.left + room.right));
        Self { area: area.clone(), plot, x, y }
    }

    /// Pixel of a point from the corner of the plot.
    fn pixel(&self, (x, y): (f64, f64)) -> (f64, f64) {
        let (width, height) = self.plot.dim_in_pixel();
        let part = |value: f64, range: &Range<f64>| (value - range.start) / (range.end - range.start);
        (part(x, &self.x) * f64::from(width), (1.0 - part(y, &self.y)) * f64::from(height))
    }

    /// Pixel of a point on the canvas.
    pub fn backend_coord(&self, point: &(f64, f64)) -> (i32, i32) {
        let ((left, top), (x, y)) = (self.plot.corner(), self.pixel(*point));
        ((left + x).round() as i32, (top + y).round() as i32)
    }

    /// Draws elements whose points are in the units of the axes; what is outside of the plot is not seen.
    pub fn draw_series(&self, elements: impl IntoIterator<Item = Element>) -> Result<(), FigureError> {
        let ((left, top), (width, height)) = (self.plot.corner(), self.plot.dim_in_pixel());
        let elements: Vec<String> =
            elements.into_iter().map(|element| element.svg(|point| self.pixel(point))).collect();
        if !elements.is_empty() {
            let (left, top, all) = (number(left), number(top), elements.join("\n"));
            self.plot.put(&format!(
                "<svg x=\"{left}\" y=\"{top}\" width=\"{width}\" height=\"{height}\" overflow=\"hidden\">\n{all}\n</svg>"
            ));
        }
        Ok(())
    }

    /// Draws the axes: about so many numbers on each, and what they are called. Without a name, x has no numbers.
    pub fn axes(&self, numbers: (usize, usize), (x, y): (&str, &str)) -> Result<(), FigureError> {
        let (width_of_plot, height) = self.plot.dim_in_pixel();
        let (right, bottom) = (width_of_plot as i32, height as i32);
        stroke(&self.plot, vec![(0, 0), (0, bottom), (right, bottom)], INK)?;
        let (left, top) = self.plot.corner();
        let letters = |at: (f64, f64), side, upwards| Letters { at, side, size: BODY, colour: INK, upwards };
        // as many numbers as there is room for
        let (across, up) = (AxisScale::of(&self.x), AxisScale::of(&self.y));
        let widest = across.ticks(&self.x, numbers.0).iter().map(|(_, text)| width(text, BODY)).max().unwrap_or(1) + 24;
        let most = (right / widest.max(1)).max(2) as usize;
        for (value, text) in across.ticks(&self.x, numbers.0.min(most)) {
            let at = self.pixel((value, self.y.start)).0.round() as i32;
            stroke(&self.plot, vec![(at, bottom), (at, bottom + TICK)], INK)?;
            if !x.is_empty() {
                let place = (left + f64::from(at), top + f64::from(bottom + NUMBER));
                self.plot.put(&letters(place, HPos::Center, false).svg(&text));
            }
        }
        let most = (bottom / 40).max(2) as usize;
        for (value, text) in up.ticks(&self.y, numbers.1.min(most)) {
            let at = self.pixel((self.x.start, value)).1.round() as i32;
            stroke(&self.plot, vec![(-TICK, at), (0, at)], INK)?;
            let place = (left - f64::from(TICK + 5), top + f64::from(at));
            self.plot.put(&letters(place, HPos::Right, false).svg(&text));
        }
        if !x.is_empty() {
            let place = (left + 0.5 * f64::from(right), top + f64::from(bottom + NUMBER + 32));
            self.plot.put(&letters(place, HPos::Center, false).svg(&across.name(x)));
        }
        let place = (self.area.corner().0 + 20.0, top + 0.5 * f64::from(bottom));
        self.plot.put(&letters(place, HPos::Center, true).svg(&up.name(y)));
        Ok(())
    }
}
