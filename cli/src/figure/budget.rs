//! How far each error displaces contact points, before and after a scan has calibrated itself.

use super::canvas::{Area, BODY, FigureError, HPos, PAGE, TITLE, stroke, svg, write};
use super::element::Element;
use super::palette::{FAINT, INK, RGBColor, TRANSITION};
use crate::budget::Forecast;

/// Height of a row and of its two bars; of the title, and of the axis below, pixels.
const ROW: i32 = 44;
const BAR: i32 = 17;
const HEAD: i32 = 116;
const FOOT: i32 = 96;
/// Where the bars begin and end, pixels.
const LEFT: i32 = 470;
const RIGHT: i32 = PAGE as i32 - 40;
/// Decades of mm that are seen at most: smaller displacements have no bar.
const DECADES: f64 = 5.0;
const COLOURS: [RGBColor; 2] = [FAINT, TRANSITION];

/// Draws a bar for each error on an axis of powers of ten.
pub(crate) fn budget(name: &str, forecast: &Forecast) -> Result<String, FigureError> {
    let sources = forecast.sources.iter().map(|share| (share.source.name().0, share.displacement));
    let noise = [forecast.noise; 2];
    let rows: Vec<(&str, [f64; 2])> =
        sources.chain([("all systematic errors", forecast.shared), ("noise", noise)]).collect();
    let largest = rows.iter().flat_map(|row| row.1).fold(f64::MIN_POSITIVE, f64::max);
    let high = (1e3 * largest).log10().ceil();
    let low = high - DECADES;
    let x = |metres: f64| {
        let part = ((1e3 * metres).max(f64::MIN_POSITIVE).log10() - low) / DECADES;
        LEFT + (part.clamp(0.0, 1.0) * f64::from(RIGHT - LEFT)).round() as i32
    };
    let bottom = HEAD + ROW * rows.len() as i32;
    svg((PAGE, (bottom + FOOT) as u32), |root| {
        let title = format!("{name}: standard deviation of single contacts across the contour, by error");
        write(root, &title, (24, 36), HPos::Left, TITLE, INK)?;
        for (colour, (text, left)) in
            COLOURS.into_iter().zip([("before any correction", 24), ("after self-calibration", 340)])
        {
            bar(root, [(left, 74), (left + 28, 94)], colour)?;
            write(root, text, (left + 40, 84), HPos::Left, BODY, INK)?;
        }
        for (number, (text, values)) in rows.iter().enumerate() {
            let top = HEAD + ROW * number as i32;
            write(root, text, (LEFT - 16, top + BAR + 2), HPos::Right, BODY, INK)?;
            for (which, colour) in COLOURS.into_iter().enumerate() {
                let top = top + 2 + BAR * which as i32;
                bar(root, [(LEFT, top), (x(values[which]), top + BAR)], colour)?;
            }
        }
        stroke(root, vec![(LEFT, HEAD), (LEFT, bottom), (RIGHT, bottom)], INK)?;
        for decade in 0..=DECADES as i32 {
            let power = low as i32 + decade;
            let at = LEFT + (RIGHT - LEFT) * decade / DECADES as i32;
            stroke(root, vec![(at, bottom), (at, bottom + 7)], INK)?;
            let text = if power < 0 {
                format!("{:.*}", -power as usize, 10_f64.powi(power))
            } else {
                format!("{}", 10_f64.powi(power))
            };
            write(root, &text, (at, bottom + 24), HPos::Center, BODY, INK)?;
        }
        write(root, "mm", ((LEFT + RIGHT) / 2, bottom + 58), HPos::Center, BODY, INK)
    })
}

fn bar(area: &Area<'_>, corners: [(i32, i32); 2], colour: RGBColor) -> Result<(), FigureError> {
    area.draw(&Element::rectangle(corners, colour.filled()))
}
