//! What all figures are drawn on: an SVG drawing in decimal pixels.

use super::element::{Element, ShapeStyle, number};
use super::palette::RGBColor;
use super::text::{Letters, tspans};
use std::cell::RefCell;
use std::fmt::Write;
use vibrissa::rod::RodError;

/// Why a figure cannot be drawn.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FigureError {
    /// The shape of the rod.
    #[error("cannot draw the rod: {0}")]
    Rod(#[from] RodError),
}

/// Pixels across a page of 180 mm, the width of two columns of most journals.
pub(crate) const PAGE: u32 = 1530;
/// Width of that page, mm.
const PAGE_MM: f64 = 180.0;
/// Size of letters, pixels: titles, and everything else. 24 pixels are 8 pt where [`PAGE`] pixels are 180 mm.
pub(crate) const TITLE: u32 = 27;
pub(crate) const BODY: u32 = 24;

pub(crate) use super::text::HPos;

/// A rectangle of pixels.
#[derive(Clone)]
pub(crate) struct Area<'a> {
    sheet: &'a RefCell<String>,
    left: u32,
    top: u32,
    width: u32,
    height: u32,
}

/// A white canvas of this size (pixels), painted, as SVG text. Its width in print is in proportion to [`PAGE`].
pub(crate) fn svg(
    (width, height): (u32, u32),
    paint: impl FnOnce(&Area<'_>) -> Result<(), FigureError>,
) -> Result<String, FigureError> {
    let sheet = RefCell::new(String::new());
    paint(&Area { sheet: &sheet, left: 0, top: 0, width, height })?;
    let mm = |pixels: u32| number(f64::from(pixels) * PAGE_MM / f64::from(PAGE));
    let head = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}mm\" height=\"{}mm\" viewBox=\"0 0 {width} {height}\" \
         font-family=\"Helvetica, Arial, sans-serif\" stroke-linejoin=\"round\">\n\
         <rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n",
        mm(width),
        mm(height)
    );
    Ok(head + &sheet.into_inner() + "</svg>\n")
}

impl<'a> Area<'a> {
    /// The parts above and below a height.
    pub fn split_vertically(&self, height: u32) -> (Self, Self) {
        let height = height.min(self.height);
        let above = Self { height, ..self.clone() };
        (above, Self { top: self.top + height, height: self.height - height, ..self.clone() })
    }

    /// The parts left and right of a width.
    pub fn split_horizontally(&self, width: u32) -> (Self, Self) {
        let width = width.min(self.width);
        let left = Self { width, ..self.clone() };
        (left, Self { left: self.left + width, width: self.width - width, ..self.clone() })
    }

    /// Width and height.
    pub fn dim_in_pixel(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    /// Its left upper corner on the canvas.
    pub fn corner(&self) -> (f64, f64) {
        (f64::from(self.left), f64::from(self.top))
    }

    /// Draws an element whose pixels count from its corner.
    pub fn draw(&self, element: &Element) -> Result<(), FigureError> {
        let (left, top) = self.corner();
        self.put(&element.svg(|(x, y)| (left + x, top + y)));
        Ok(())
    }

    /// Adds SVG text.
    pub fn put(&self, text: &str) {
        let mut sheet = self.sheet.borrow_mut();
        sheet.push_str(text);
        sheet.push('\n');
    }
}

/// Text at a point, which is its middle in height and what `side` says in width. `_{...}` lowers a part of it.
pub(crate) fn write(
    area: &Area<'_>,
    text: &str,
    at: (i32, i32),
    side: HPos,
    size: u32,
    colour: RGBColor,
) -> Result<(), FigureError> {
    let (left, top) = area.corner();
    let at = (left + f64::from(at.0), top + f64::from(at.1));
    area.put(&Letters { at, side, size, colour, upwards: false }.svg(text));
    Ok(())
}

/// About how wide a text is, pixels. Nothing here knows the reader's font: common ones are no wider.
pub(crate) fn width(text: &str, size: u32) -> i32 {
    let em = f64::from(size);
    let letter = |letter: char| match letter {
        ' ' | ',' | '.' | ':' | ';' | '(' | ')' | 'i' | 'l' => 0.34,
        'm' | 'w' => 0.85,
        _ if letter.is_uppercase() => 0.7,
        _ => 0.57,
    };
    let lengths = tspans(text).map(|(part, low)| {
        let length: f64 = part.chars().map(letter).sum();
        if low { 0.7 * length } else { length }
    });
    (em * lengths.sum::<f64>()).ceil() as i32
}

/// A straight or broken line in pixels.
pub(crate) fn stroke(
    area: &Area<'_>,
    points: Vec<(i32, i32)>,
    style: impl Into<ShapeStyle>,
) -> Result<(), FigureError> {
    area.draw(&Element::line(points, style))
}

/// A number on an axis, as short as it can be.
pub(crate) fn tick(value: &f64) -> String {
    // Ticks are multiples of a step like 0.05 with the last bits off, and -0.
    let mut text = String::new();
    let _ = write!(text, "{:.6}", if value.abs() < 1e-9 { 0.0 } else { *value });
    text.trim_end_matches('0').trim_end_matches('.').replace('-', "\u{2212}")
}

/// The interval from the least to the largest value, widened by a part of its length on both sides.
pub(crate) fn span(values: impl IntoIterator<Item = f64>, margin: f64) -> std::ops::Range<f64> {
    let (least, most) = values
        .into_iter()
        .filter(|value| value.is_finite())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), value| (least.min(value), most.max(value)));
    match most - least {
        length if length > 0.0 => least - margin * length..most + margin * length,
        // One value, or none at all.
        0.0 => least - 1.2..most + 1.2,
        _ => -1.2..1.2,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_short_and_zero_has_no_sign() {
        let ticks: Vec<String> = [0.15000000000000002, -80.0, -1e-17, 100.0].iter().map(tick).collect();
        assert_eq!(ticks, ["0.15", "\u{2212}80", "0", "100"]);
    }

    #[test]
    fn a_span_is_never_empty() {
        assert_eq!(span([2.0, 4.0], 0.5), 1.0..5.0);
        assert_eq!(span([3.0], 0.5), 1.8..4.2);
        assert_eq!(span([], 0.5), -1.2..1.2);
    }

    #[test]
    fn a_page_is_180_mm_wide_and_its_letters_8_pt_high() {
        let drawing = svg((PAGE, 765), |area| write(area, "a", (10, 10), HPos::Left, BODY, RGBColor(0, 0, 0))).unwrap();
        assert!(drawing.contains("width=\"180mm\" height=\"90mm\" viewBox=\"0 0 1530 765\""), "{drawing}");
        let points = f64::from(BODY) * PAGE_MM / f64::from(PAGE) / 25.4 * 72.0;
        assert!((7.99..8.1).contains(&points), "{points}");
    }
}
