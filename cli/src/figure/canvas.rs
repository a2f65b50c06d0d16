//! What all figures are drawn on and with.

use plotters::coord::Shift;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use vibrissa::RodError;

/// Why a figure cannot be drawn.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FigureError {
    /// The drawing.
    #[error("cannot draw the figure: {0}")]
    Drawing(String),
    /// The shape of the rod.
    #[error("cannot draw the rod: {0}")]
    Rod(#[from] RodError),
}

impl<E: std::error::Error + Send + Sync> From<DrawingAreaErrorKind<E>> for FigureError {
    fn from(error: DrawingAreaErrorKind<E>) -> Self {
        Self::Drawing(error.to_string())
    }
}

/// A rectangle of pixels.
pub(super) type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// A rectangle with axes.
pub(super) type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

/// Size of letters: titles, everything else. Coordinates are whole pixels, so figures are drawn large, to be scaled down.
pub(super) const TITLE: u32 = 30;
pub(super) const BODY: u32 = 24;

/// A white canvas of this size (pixels), painted, as SVG text.
pub(super) fn svg(
    size: (u32, u32),
    paint: impl FnOnce(&Area<'_>) -> Result<(), FigureError>,
) -> Result<String, FigureError> {
    let mut text = String::new();
    let root = SVGBackend::with_string(&mut text, size).into_drawing_area();
    root.fill(&WHITE)?;
    paint(&root)?;
    root.present()?;
    drop(root);
    Ok(text)
}

/// Text at a point, which is its middle in height and what `side` says in width.
pub(super) fn write(
    area: &Area<'_>,
    text: &str,
    at: (i32, i32),
    side: HPos,
    size: u32,
    colour: RGBColor,
) -> Result<(), FigureError> {
    let style = ("sans-serif", size).into_font().color(&colour).pos(Pos::new(side, VPos::Center));
    Ok(area.draw(&Text::new(text.to_owned(), at, style))?)
}

/// About how wide a text is, pixels. Nothing here knows the reader's font: common ones are no wider.
pub(super) fn width(text: &str, size: u32) -> i32 {
    // A font of one em has lines 1.24 em high, which is the size by which it is called here.
    let em = f64::from(size) / 1.24;
    let letter = |letter: char| match letter {
        ' ' => 0.35,
        _ if letter.is_uppercase() => 0.72,
        _ => 0.64,
    };
    (em * text.chars().map(letter).sum::<f64>()).ceil() as i32
}

/// A straight or broken line in pixels.
pub(super) fn stroke(
    area: &Area<'_>,
    points: Vec<(i32, i32)>,
    style: impl Into<ShapeStyle>,
) -> Result<(), FigureError> {
    Ok(area.draw(&PathElement::new(points, style))?)
}

/// Draws the axes of a chart: about so many numbers on each, and what they are called.
pub(super) fn axes(
    chart: &mut Chart<'_, '_>,
    numbers: (usize, usize),
    (x, y): (&str, &str),
) -> Result<(), FigureError> {
    let letters = ("sans-serif", BODY);
    let mut mesh = chart.configure_mesh();
    mesh.disable_mesh().x_labels(numbers.0).y_labels(numbers.1).x_label_formatter(&tick).y_label_formatter(&tick);
    Ok(mesh.label_style(letters).axis_desc_style(letters).x_desc(x).y_desc(y).draw()?)
}

/// A number on an axis, as short as it can be.
pub(super) fn tick(value: &f64) -> String {
    // Ticks are multiples of a step like 0.05 with the last bits off, and -0.
    let text = format!("{:.6}", if value.abs() < 1e-9 { 0.0 } else { *value });
    text.trim_end_matches('0').trim_end_matches('.').replace('-', "\u{2212}")
}

/// The interval from the least to the largest value, widened by a part of its length on both sides.
pub(super) fn span(values: impl IntoIterator<Item = f64>, margin: f64) -> std::ops::Range<f64> {
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
}
